#include "window/ui/ui.h"

#include <SDL2/SDL.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui/backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

namespace burr::app {
namespace {

// Inter, otherwise a font that nearly every Debian has; regular and bold
constexpr std::pair<const char*, const char*> kFaces[] = {
    {"/usr/share/fonts/opentype/inter/Inter-Regular.otf",
     "/usr/share/fonts/opentype/inter/Inter-SemiBold.otf"},
    {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
     "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf"}};

std::vector<char> bytes_of(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Latin letters of the languages of Europe, and the few signs that the window uses: dashes, dots,
// arrows
const ImWchar kGlyphs[] = {0x20, 0x17F, 0x2013, 0x2014, 0x2026, 0x2026, 0x2190, 0x2193, 0};

ImVec4 colour(ImU32 c) { return ImGui::ColorConvertU32ToFloat4(c); }

}  // namespace

std::unique_ptr<Ui> Ui::make() {
  std::unique_ptr<Ui> ui(new Ui);
  ui->context_ = ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // positions of panels are fixed, not saved
  io.LogFilename = nullptr;
  io.BackendPlatformName = "burr";
  io.UserData = ui.get();  // for text_field()
  ImGui_ImplOpenGL3_Init(epoxy_is_desktop_gl() ? "#version 330 core" : "#version 300 es");
  return ui;
}

Ui::~Ui() {
  if (context_ == nullptr) return;
  ImGui::SetCurrentContext(context_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
}

// ---- events

void Ui::event(const SDL_Event& event) {
  ImGuiIO& io = ImGui::GetIO();
  const auto button = [](Uint8 sdl) {
    return sdl == SDL_BUTTON_LEFT ? 0 : sdl == SDL_BUTTON_RIGHT ? 1 : 2;
  };
  switch (event.type) {
    case SDL_MOUSEMOTION:
      mouse_x_ = static_cast<float>(event.motion.x);
      mouse_y_ = static_cast<float>(event.motion.y);
      if (!mouse_.empty() && mouse_.back().button < 0)
        mouse_.back() = {mouse_x_, mouse_y_, -1, false};
      else
        mouse_.push_back({mouse_x_, mouse_y_, -1, false});
      break;
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      mouse_.push_back(
          {mouse_x_, mouse_y_, button(event.button.button), event.type == SDL_MOUSEBUTTONDOWN});
      break;
    case SDL_MOUSEWHEEL:
      io.MouseWheel += static_cast<float>(event.wheel.y);
      break;
    case SDL_TEXTINPUT:
      io.AddInputCharactersUTF8(event.text.text);
      break;
    case SDL_KEYDOWN:
    case SDL_KEYUP: {
      SDL_Scancode scancode = event.key.keysym.scancode;
      if (scancode == SDL_SCANCODE_UNKNOWN) scancode = SDL_GetScancodeFromKey(event.key.keysym.sym);
      // Ctrl + Z is the key on which Z is printed, wherever it lies
      if (const SDL_Keycode key = event.key.keysym.sym; key >= SDLK_a && key <= SDLK_z)
        scancode = static_cast<SDL_Scancode>(SDL_SCANCODE_A + (key - SDLK_a));
      if (scancode < SDL_NUM_SCANCODES) {
        if (event.type == SDL_KEYDOWN) {
          keys_.keys[scancode] = true;
          fresh_.push_back(scancode);
        } else if (std::find(fresh_.begin(), fresh_.end(), scancode) != fresh_.end()) {
          let_go_.push_back(scancode);
        } else {
          keys_.keys[scancode] = false;
        }
      }
      // of keys that went down since the last frame, those held with the last of them count: all
      // of Ctrl + A may happen within one frame
      if (event.type == SDL_KEYUP && !fresh_.empty()) break;
      const unsigned held = event.key.keysym.mod;
      keys_.shift = (held & KMOD_SHIFT) != 0;
      keys_.ctrl = (held & KMOD_CTRL) != 0;
      keys_.alt = (held & KMOD_ALT) != 0;
      break;
    }
    case SDL_WINDOWEVENT:
      if (event.window.event != SDL_WINDOWEVENT_FOCUS_LOST) break;
      keys_.keys.reset();
      std::fill(std::begin(down_), std::end(down_), false);
      std::erase_if(mouse_, [](const MouseStep& step) { return step.button >= 0; });
      break;
    default:
      break;
  }
}

void Ui::begin(int window_width, int window_height, int width, int height, double user_scale,
               bool keys) {
  ImGuiIO& io = ImGui::GetIO();
  // at least the scale that the screen reports; a large window gets larger letters
  float dpi = 96;
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) {
    const int display = std::max(0, SDL_GetWindowDisplayIndex(window));
    if (SDL_GetDisplayDPI(display, &dpi, nullptr, nullptr) != 0) dpi = 96;
  }
  const float natural =
      std::clamp(std::max(dpi / 96, static_cast<float>(height) / 1080), 1.0F, 4.0F);
  // also a small window must hold the panels, which are designed for 1240 x 620 points
  const float room = std::min(static_cast<float>(width) / 1240, static_cast<float>(height) / 620);
  float unit = std::min(natural * static_cast<float>(user_scale), std::max(room, 0.6F));
  unit = std::max(0.6F, std::round(unit * 8) / 8);
  if (unit != unit_) {
    unit_ = unit;
    style();
    build_fonts();
  }
  from_window_ = static_cast<float>(width) / static_cast<float>(std::max(1, window_width));
  static_cast<void>(window_height);
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  take_mouse();
  io.MousePos =
      seen_x_ < 0 ? ImVec2(-1e30F, -1e30F) : ImVec2(seen_x_ * from_window_, seen_y_ * from_window_);
  for (int b = 0; b < 3; ++b) io.MouseDown[b] = down_[b];
  for (const SDL_Scancode scancode : up_) keys_.keys[scancode] = false;
  up_ = std::exchange(let_go_, {});
  // a modifier that was pressed and released within one frame counts in that frame, and ends in the next
  if (fresh_.empty() && up_.empty()) {
    const SDL_Keymod held = SDL_GetModState();
    keys_.shift = keys_.shift && (held & KMOD_SHIFT) != 0;
    keys_.ctrl = keys_.ctrl && (held & KMOD_CTRL) != 0;
    keys_.alt = keys_.alt && (held & KMOD_ALT) != 0;
  }
  fresh_.clear();
  tell_imgui(keys_);
  io.ConfigFlags = keys ? ImGuiConfigFlags_NavEnableKeyboard : ImGuiConfigFlags_None;
  const Uint64 now = SDL_GetPerformanceCounter();
  const double passed = last_ == 0 ? 1.0 / 60
                                   : static_cast<double>(now - last_) /
                                         static_cast<double>(SDL_GetPerformanceFrequency());
  io.DeltaTime = static_cast<float>(std::clamp(passed, 1e-4, 0.25));
  last_ = now;
  forget_panels();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

// Up to the next change of a button: on a slow computer a whole click, and a way from there to
// elsewhere, may happen within one picture.
void Ui::take_mouse() {
  while (!mouse_.empty()) {
    const MouseStep step = mouse_.front();
    mouse_.pop_front();
    seen_x_ = step.x;
    seen_y_ = step.y;
    if (step.button < 0) continue;
    down_[step.button] = step.down;
    return;
  }
}

void Ui::draw() {
  if (ImGui::GetDrawData() == nullptr) ImGui::Render();  // once, even if two eyes are drawn
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Ui::own_pointer(bool on) {
  ImGuiIO& io = ImGui::GetIO();
  if (io.MouseDrawCursor == on) return;
  io.MouseDrawCursor = on;
  SDL_ShowCursor(on ? SDL_DISABLE : SDL_ENABLE);
}

float Ui::width() const { return ImGui::GetIO().DisplaySize.x; }
float Ui::height() const { return ImGui::GetIO().DisplaySize.y; }
// WantTextInput is that of the last picture: a field that has been left since is not active any
// more, and one that became active in that picture is not in it yet. A click that no picture has seen
// decides for the keys behind it.
bool Ui::typing() const {
  bool types = field_has_keys_ || (ImGui::GetIO().WantTextInput && ImGui::IsAnyItemActive());
  for (const MouseStep& step : mouse_)
    if (step.button == 0 && step.down)
      types = holds(fields_, step.x * from_window_, step.y * from_window_);
  return types;
}
void Ui::field() {
  const ImVec2 least = ImGui::GetItemRectMin(), size = ImGui::GetItemRectSize();
  fields_.push_back({least.x, least.y, size.x, size.y});
  field_has_keys_ = field_has_keys_ || ImGui::IsItemActive();
}
bool Ui::first_field(float& window_x, float& window_y) const {
  if (fields_.empty()) return false;
  const Box& box = fields_.front();
  window_x = (box.x + box.w / 2) / from_window_;
  window_y = (box.y + box.h / 2) / from_window_;
  return true;
}
bool Ui::holds(const std::vector<Box>& boxes, float x, float y) {
  return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
    return x >= box.x && x < box.x + box.w && y >= box.y && y < box.y + box.h;
  });
}
bool Ui::over_panel(float window_x, float window_y) const {
  return holds(boxes_, window_x * from_window_, window_y * from_window_);
}

// ---- fonts and style

void Ui::build_fonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  letters_.clear();
  const float sizes[] = {12.5F, 15, 15, 23, 34};
  const auto load = [&](const char* path, float size) -> ImFont* {
    const std::vector<char> file = bytes_of(path);
    if (file.empty()) return nullptr;
    void* copy = ImGui::MemAlloc(file.size());  // the atlas owns it
    std::memcpy(copy, file.data(), file.size());
    ImFontConfig config;
    config.OversampleH = 2;
    config.PixelSnapH = true;
    return atlas.AddFontFromMemoryTTF(copy, static_cast<int>(file.size()), std::round(size * unit_),
                                      &config, kGlyphs);
  };
  for (int n = 0; n < 5; ++n) fonts_[n] = nullptr;
  for (const auto& [regular, bold] : kFaces) {
    for (int n = 0; n < 5; ++n) fonts_[n] = load(n >= 2 ? bold : regular, sizes[n]);
    if (fonts_[0] != nullptr && fonts_[2] != nullptr) {
      letters_ = regular;
      break;
    }
    atlas.Clear();
  }
  if (letters_.empty()) {  // no such font on this computer: ImGui's own, larger
    ImFontConfig config;
    for (int n = 0; n < 5; ++n) {
      config.SizePixels = std::round(std::max(13.0F, sizes[n]) * unit_);
      fonts_[n] = atlas.AddFontDefault(&config);
    }
  }
  ImGui::GetIO().FontDefault = fonts_[1];
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Ui::style() const {
  ImGuiStyle& s = ImGui::GetStyle();
  s = ImGuiStyle();
  ImGui::StyleColorsDark(&s);
  s.WindowPadding = {12, 10};
  s.FramePadding = {10, 6};
  s.ItemSpacing = {10, 8};
  s.ItemInnerSpacing = {8, 6};
  s.ScrollbarSize = 12;
  s.GrabMinSize = 14;
  s.WindowRounding = 8;
  s.ChildRounding = 6;
  s.FrameRounding = 6;
  s.PopupRounding = 6;
  s.GrabRounding = 6;
  s.ScrollbarRounding = 6;
  s.WindowBorderSize = 0;
  s.FrameBorderSize = 0;
  s.ScaleAllSizes(unit_);
  const auto set = [&s](ImGuiCol which, ImU32 to) { s.Colors[which] = colour(to); };
  set(ImGuiCol_Text, ink::kText);
  set(ImGuiCol_TextDisabled, ink::kDim);
  set(ImGuiCol_WindowBg, ink::kPanel);
  set(ImGuiCol_ChildBg, ink::rgb(0, 0, 0, 0));
  set(ImGuiCol_PopupBg, ink::rgb(24, 27, 31, 250));
  set(ImGuiCol_Border, ink::kLine);
  set(ImGuiCol_FrameBg, ink::kButton);
  set(ImGuiCol_FrameBgHovered, ink::kOver);
  set(ImGuiCol_FrameBgActive, ink::kOver);
  set(ImGuiCol_Button, ink::kButton);
  set(ImGuiCol_ButtonHovered, ink::kOver);
  set(ImGuiCol_ButtonActive, ink::rgb(86, 180, 233, 110));
  set(ImGuiCol_Header, ink::rgb(86, 180, 233, 70));
  set(ImGuiCol_HeaderHovered, ink::rgb(86, 180, 233, 100));
  set(ImGuiCol_HeaderActive, ink::rgb(86, 180, 233, 115));
  set(ImGuiCol_CheckMark, ink::kAccent);
  set(ImGuiCol_SliderGrab, ink::kAccent);
  set(ImGuiCol_SliderGrabActive, ink::kText);
  set(ImGuiCol_PlotHistogram, ink::kAccent);
  set(ImGuiCol_NavHighlight, ink::kAccent);
  set(ImGuiCol_ScrollbarBg, ink::rgb(0, 0, 0, 0));
  set(ImGuiCol_TextSelectedBg, ink::rgb(86, 180, 233, 110));
}

// ---- parts of panels

void Ui::panel(const char* name, float x, float y, float w, float h, bool plain) {
  if (!plain) boxes_.push_back({x, y, w, h});
  ImGui::SetNextWindowPos({x, y});
  ImGui::SetNextWindowSize({w, h});
  ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                           ImGuiWindowFlags_NoFocusOnAppearing |
                           ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (plain) flags |= ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoInputs;
  ImGui::Begin(name, nullptr, flags);
}

void Ui::page(const char* name, float x, float y, float w, float h) {
  boxes_.push_back({x, y, w, h});
  ImGui::SetNextWindowPos({x, y});
  ImGui::SetNextWindowSize({w, h});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {22 * unit_, 18 * unit_});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, w >= width() ? 0 : 8 * unit_);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ink::rgb(17, 19, 22, 251));
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
}

void Ui::write(float x, float y, Letter letter, ImU32 ink, const std::string& text,
               float aligned) const {
  tell(text);
  ImFont* which = font(letter);
  if (aligned != 0) x -= aligned * width_of(letter, text);
  ImGui::GetWindowDrawList()->AddText(which, which->FontSize, {std::round(x), std::round(y)}, ink,
                                      text.data(), text.data() + text.size());
}

float Ui::width_of(Letter letter, const std::string& text) const {
  const ImFont* which = font(letter);
  return which->CalcTextSizeA(which->FontSize, 1e9F, 0, text.data(), text.data() + text.size()).x;
}
float Ui::height_of(Letter letter) const { return font(letter)->FontSize; }

void focus_next() {
  ImGui::SetWindowFocus();
  ImGui::SetKeyboardFocusHere();
}

bool text_field(const char* id, const char* hint, std::string& text, float width,
                std::string (*complete)(const std::string&)) {
  std::vector<char> buffer(4096, '\0');
  std::copy_n(text.c_str(), std::min(text.size(), buffer.size() - 1), buffer.begin());
  ImGui::SetNextItemWidth(width);
  const ImGuiInputTextCallback completing = [](ImGuiInputTextCallbackData* field) {
    using Complete = std::string (*)(const std::string&);
    const std::string whole = (*static_cast<Complete*>(field->UserData))(field->Buf);
    if (whole == field->Buf || whole.size() >= static_cast<std::size_t>(field->BufSize)) return 0;
    field->DeleteChars(0, field->BufTextLen);
    field->InsertChars(0, whole.c_str());
    return 0;
  };
  const bool entered = ImGui::InputTextWithHint(
      id, hint, buffer.data(), buffer.size(),
      ImGuiInputTextFlags_EnterReturnsTrue |
          (complete != nullptr ? ImGuiInputTextFlags_CallbackCompletion : 0),
      complete != nullptr ? completing : nullptr, static_cast<void*>(&complete));
  static_cast<Ui*>(ImGui::GetIO().UserData)->field();
  text = buffer.data();
  return entered;
}

}  // namespace burr::app
