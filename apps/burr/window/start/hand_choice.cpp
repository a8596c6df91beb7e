#include "window/start/hand_choice.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>
#include <vector>

#include "burr/workshop/device_book.h"
#include "shared/front_words.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;

constexpr float kLines = 3;                // most lines for the result
constexpr std::chrono::seconds kAgain(3);  // between two checks for a device that was not found

// True for a kind of device that may have to move by itself to find its position.
bool homes(const std::string& device) {
  return device.starts_with("force-dimension") || device.starts_with("crtk");
}

// The possible choices, as written after --device; "" is the mouse.
std::vector<std::string> choices(const std::string& requested) {
  std::vector<std::string> all = {""};
  for (const workshop::HandKind& kind : workshop::hand_kinds()) {
    all.emplace_back(kind.name);
    if (requested.starts_with(all.back() + ":")) all.push_back(requested);
  }
  return all;
}

std::string shown(const std::string& device) {
  if (device.empty()) return word(Word::hand_mouse);
  const std::string kind = device.substr(0, device.find(':'));
  for (const workshop::HandKind& one : workshop::hand_kinds())
    if (kind == one.name) return fmt::format("{}: {}", device, one.makes);
  return device;
}

}  // namespace

HandChoice::HandChoice(workshop::HandRequest request) : request_(std::move(request)) { look(); }

void HandChoice::look() {
  looked_ = std::chrono::steady_clock::now();
  if (request_.device.empty()) return;
  workshop::HandRequest asked = request_;
  asked.home = false;  // no movement before there is a bone
  looks_ = std::async(std::launch::async, [asked]() -> Found {
    auto device = workshop::make_hand(asked);
    if (!device) return {false, in_options(device.error()).text};
    const Status opened = (*device)->open();
    if (!opened) return {false, in_options(opened.error()).text};
    const device::DeviceSpec spec = (*device)->spec();
    (*device)->close();
    return {true, fmt::format("{}: {:.1f} N, {:.0f} Hz", workshop::id_of(spec), spec.peak_force,
                              spec.native_rate)};
  });
}

void HandChoice::rest() {
  if (!looks_.valid()) return;
  Found found = looks_.get();
  words_ = std::move(found.words);
  there_ = found.there;
}

bool HandChoice::draw(Ui& ui, float x, float y, float w) {
  const float u = ui.unit();
  if (looks_.valid() && looks_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
    rest();
  if (there_ == false && !looks_.valid() && std::chrono::steady_clock::now() - looked_ > kAgain)
    look();
  ui.write(x, y + 5 * u, Letter::strong, ink::kAccent, word(Word::hand_title));
  const float beside = 92 * u;
  ImGui::SetCursorScreenPos({x + beside, y});
  ImGui::SetNextItemWidth(w - beside);
  bool changed = false;
  const std::string preview = request_.device.empty() ? shown({}) : request_.device;
  if (ImGui::BeginCombo("##hand", preview.c_str(), ImGuiComboFlags_PopupAlignLeft)) {
    for (const std::string& device : choices(request_.device))
      if (ImGui::Selectable(shown(device).c_str(), device == request_.device) &&
          device != request_.device) {
        request_ =
            workshop::HandRequest();  // permission to move is not passed on to another device
        request_.device = device;
        changed = true;
      }
    ImGui::EndCombo();
  }
  if (changed) {
    rest();  // waits for the check of the earlier choice
    words_.clear();
    there_.reset();
    look();
  }
  y += 36 * u;
  if (homes(request_.device)) {
    ImGui::SetCursorScreenPos({x, y});
    ImGui::Checkbox(word(Word::hand_home), &request_.home);
    y += 32 * u;
  }
  if (request_.device.empty()) return changed;

  const std::string text = there_ ? words_ : word(Word::hand_looks);
  const ImFont* font = ui.font(Letter::small);
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  draw.PushClipRect({x, y}, {x + w, y + kLines * 1.2F * font->FontSize}, true);
  draw.AddText(font, font->FontSize, {x, y},
               !there_   ? ink::kDim
               : *there_ ? ink::kGood
                         : ink::kWarn,
               text.c_str(), nullptr, w);
  draw.PopClipRect();
  return changed;
}

}  // namespace burr::app
