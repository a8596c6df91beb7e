#include "window/replay/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "shared/front_words.h"
#include "shared/word_names.h"
#include "window/parts/hud.h"
#include "window/replay/timeline_panel.h"

namespace burr::app {
namespace {

using Letter = Ui::Letter;
using render::Image;

constexpr std::size_t kMostRows = 6;  // of the table of tissues

ImU32 ink_of(const render::Colour& colour) {
  const auto part = [&](std::size_t n) {
    return static_cast<unsigned>(std::lround(255 * static_cast<double>(colour[n])));
  };
  return ink::rgb(part(0), part(1), part(2));
}

}  // namespace

// ---- measuring

FactsJob::FactsJob(const Recorded& recorded)
    : work_(std::make_unique<Loading<Facts>>(
          [file = recorded.film.recording, volume = recorded.film.volume](Progress& progress) {
            return facts_of(file, volume, progress);
          })) {}

void FactsJob::step() {
  if (!work_ || !work_->finished()) return;
  auto facts = work_->take();
  work_.reset();
  if (facts)
    facts_.emplace(std::move(*facts));
  else if (facts.error().trouble != Trouble::interrupted)
    trouble_ = in_options(facts.error()).text;
}

// ---- in slices

// Fills what was removed in a slice, from slices of both bones and of the bone before.
class Comparison::InSlices {
 public:
  InSlices(const std::shared_ptr<volume::Bone>& before, ReplayView& left, ReplayView& right)
      : keep_(before), before_(*before), left_(left), right_(right) {}

  void paint(const render::Slice& slice, Image& image) {
    render::Slice plain = slice;
    plain.labels = false;
    plain.greys = nullptr;
    for (Image* each : {&was_, &is_left_, &is_right_}) {
      each->width = image.width;
      each->height = image.height;
    }
    before_.draw(plain, was_);
    left_.plain_slicer().draw(plain, is_left_);
    right_.plain_slicer().draw(plain, is_right_);
    constexpr std::uint8_t kBone = 114;  // between the grey of air and that of bone
    constexpr float kShare = 0.8F;
    for (std::size_t n = 0; n + 2 < image.rgb.size(); n += 3) {
      const Cut cut =
          cut_in(was_.rgb[n] > kBone, is_left_.rgb[n] > kBone, is_right_.rgb[n] > kBone);
      if (cut == Cut::none) continue;
      const render::Colour& colour = cut == Cut::left_only    ? kLeftOnly
                                     : cut == Cut::right_only ? kRightOnly
                                                              : kBothCut;
      for (std::size_t c = 0; c < 3; ++c)
        image.rgb[n + c] = static_cast<std::uint8_t>(std::lround(
            kShare * 255 * colour[c] + (1 - kShare) * static_cast<float>(image.rgb[n + c])));
    }
  }

 private:
  std::shared_ptr<volume::Bone> keep_;
  render::Slicer before_;
  ReplayView &left_, &right_;
  Image was_, is_left_, is_right_;
};

// ---- both

Comparison::Comparison(ReplayView& left, ReplayView& right)
    : left_(left), right_(right), right_facts_(right.recorded()) {}

Comparison::~Comparison() { colour(false); }

void Comparison::step(const Facts* left) {
  right_facts_.step();
  if (difference_ || left == nullptr || right() == nullptr) return;
  if (!same_grid(left->before->grid(), right()->before->grid()) || left->hash != right()->hash)
    return;
  difference_.emplace(left->before);
  in_slices_ = std::make_unique<InSlices>(left->before, left_, right_);
}

void Comparison::colour(bool on) {
  const bool now =
      on && difference_ && left_.has_difference_colours() && right_.has_difference_colours();
  for (ReplayView* side : {&left_, &right_})
    side->slices().paint_with(
        now ? [this](const render::Slice& slice, Image& image) { in_slices_->paint(slice, image); }
            : Slices::Paint());
  const bool rests = left_.settled() && right_.settled();
  const bool same = left_.shown() == left_t_ && right_.shown() == right_t_;
  if (now && rests && same) return;  // painted already
  if (difference_) difference_->unpaint();
  left_t_ = right_t_ = -1;
  if (!now || !rests) return;
  left_.look_plain();
  right_.look_plain();
  difference_->paint(left_.scene(), *left_.recorded().bone, right_.scene(),
                     *right_.recorded().bone);
  left_t_ = left_.shown();
  right_t_ = right_.shown();
}

bool Comparison::draw(Ui& ui, float x, float y, const Facts* left, bool colours) const {
  const float u = ui.unit(), w = kWide * u, line = 20 * u;
  const Facts* right = this->right();
  const bool known = left != nullptr && right != nullptr;
  std::vector<LossRow> rows = known ? compared(left->lost, right->lost) : std::vector<LossRow>();
  if (rows.size() > kMostRows) rows.resize(kMostRows);
  const std::size_t lines = known ? rows.size() + 5 : 2;
  const float h = static_cast<float>(lines) * line + (known ? 78 : 12) * u;
  ui.panel("##compared", x, y, w, h);
  float at = y + 10 * u;
  const float name = x + 22 * u, first = x + w - 100 * u, second = x + w - 14 * u;
  const auto row = [&](const std::string& text, const std::string& a, const std::string& b,
                       ImU32 colour = ink::kText) {
    ui.write(name, at, Letter::small, colour, text);
    ui.write(first, at, Letter::small, colour, a, 1);
    ui.write(second, at, Letter::small, colour, b, 1);
    at += line;
  };
  row(word(Word::beside_title), word(Word::beside_left), word(Word::beside_right), ink::kDim);
  if (!known) {
    const std::string& trouble = right_facts_.trouble();
    ui.write(name, at, Letter::small, ink::kText,
             trouble.empty() ? word(Word::beside_counting) : trouble);
    ImGui::End();
    return false;
  }
  for (const LossRow& each : rows) {
    if (each.spare)
      ImGui::GetWindowDrawList()->AddTriangleFilled({x + 9 * u, at + 12 * u},
                                                    {x + 17 * u, at + 12 * u},
                                                    {x + 13 * u, at + 4 * u}, ink::kWarn);
    row(anatomy(each.name), fmt::format("{:.1f}", 1e9 * each.left),
        fmt::format("{:.1f}", 1e9 * each.right), each.spare ? ink::kWarn : ink::kText);
  }
  if (rows.empty()) row(word(Word::beside_nothing), "", "");
  const auto least = [](const Facts& facts) {
    const auto found = facts.least();
    return found ? fmt::format("{:.2f}", 1e3 * found->distance) : std::string("-");
  };
  row(word(Word::beside_nearest), least(*left), least(*right));
  const auto where = [](const Facts& facts) {
    const auto found = facts.least();
    return found ? fmt::format("{} {}", anatomy(found->name), clock_of(found->t))
                 : std::string("-");
  };
  ui.write(name, at, Letter::small, ink::kDim, where(*left) + "  |  " + where(*right));
  at += line;
  row(word(Word::beside_violations), fmt::format("{}", left->violations.size()),
      fmt::format("{}", right->violations.size()),
      left->violations.empty() && right->violations.empty() ? ink::kText : ink::kWarn);

  bool pressed = false;
  if (comparable()) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    ImGui::SetCursorScreenPos({name, at + 4 * u});
    pressed = ImGui::Button(
        fmt::format("{}  [C]", word(colours ? Word::beside_no_colours : Word::beside_colours))
            .c_str(),
        {w - 36 * u, 0});
    at += 44 * u;
    float next = name;
    for (const auto& [colour, text] : {std::pair{kLeftOnly, Word::beside_left_only},
                                       {kRightOnly, Word::beside_right_only},
                                       {kBothCut, Word::beside_both}}) {
      draw.AddRectFilled({next, at + 3 * u}, {next + 10 * u, at + 13 * u}, ink_of(colour), 2 * u);
      ui.write(next + 14 * u, at, Letter::small, ink::kText, word(text));
      next += 24 * u + ui.width_of(Letter::small, word(text));
    }
  } else {
    ui.write(name, at + 4 * u, Letter::small, ink::kDim, word(Word::beside_other_bone));
  }
  ImGui::End();
  return pressed;
}

}  // namespace burr::app
