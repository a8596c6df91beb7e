// tests/render/gpu.h - a renderer without a display, or a skipped test where there is no OpenGL at
// all.
#pragma once

#include <gtest/gtest.h>

#include "burr/render/renderer.h"
#include "support/data.h"

// First line of a test that draws: `gpu` is a Renderer. Skips with the reason where there is no
// OpenGL, and fails where CI requires it.
#define BURR_NEEDS_GPU(gpu)                                                     \
  auto gpu##_or_trouble = burr::render::Renderer::offscreen();                  \
  if (!gpu##_or_trouble) {                                                      \
    ASSERT_FALSE(burr::test::data_required()) << gpu##_or_trouble.error().text; \
    GTEST_SKIP() << gpu##_or_trouble.error().text;                              \
  }                                                                             \
  [[maybe_unused]] burr::render::Renderer& gpu = **gpu##_or_trouble
