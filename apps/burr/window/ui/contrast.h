// apps/burr/window/ui/contrast.h - how well a text can be told from what lies behind it, by WCAG 2.2.
//
//     contrast(ink::kText, over(ink::kPanel, white))
//
//     C = (L1 + 0.05) / (L2 + 0.05)      L: relative luminance of sRGB, L1 the lighter
//
// Level AA (success criteria 1.4.3 and 1.4.11): text 4.5, large text (24 px, or 18.7 px bold) and marks
// 3. Colours as ImGui packs them (Ui's ink). Pure. Thread: any.
// Source: https://www.w3.org/TR/WCAG22/#dfn-contrast-ratio
#pragma once

#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>

namespace burr::app {

inline constexpr double kTextContrast = 4.5, kLargeContrast = 3;

// The part of a packed colour, 0 red to 3 alpha, 0..1.
[[nodiscard]] inline double part_of(ImU32 colour, unsigned part) {
  return static_cast<double>(colour >> (8 * part) & 0xFFU) / 255;
}

// A colour that lets something shine through, on an opaque colour behind it.
[[nodiscard]] inline ImU32 over(ImU32 colour, ImU32 behind) {
  const double alpha = part_of(colour, 3);
  ImU32 seen = 0xFFU << 24U;
  for (unsigned n = 0; n < 3; ++n) {
    const double value = alpha * part_of(colour, n) + (1 - alpha) * part_of(behind, n);
    seen |= static_cast<ImU32>(std::lround(255 * value)) << (8 * n);
  }
  return seen;
}

[[nodiscard]] inline double luminance(ImU32 colour) {
  const auto linear = [colour](unsigned n) {
    const double s = part_of(colour, n);
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(0) + 0.7152 * linear(1) + 0.0722 * linear(2);
}

// 1 to 21. Both opaque.
[[nodiscard]] inline double contrast(ImU32 a, ImU32 b) {
  const double one = luminance(a), other = luminance(b);
  return (std::max(one, other) + 0.05) / (std::min(one, other) + 0.05);
}

}  // namespace burr::app
