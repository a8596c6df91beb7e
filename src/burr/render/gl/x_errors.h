// render/gl/x_errors.h - errors of the X server, which by default end the program with a text of
// their own. In a file of its own, because X11's headers define names such as Status as macros. For
// use of this room only.
//
//     catch_x_errors();                          // once SDL has started its video
//     forget_x_error();  ... make a window and a context ...
//     if (std::string why = x_error(window); !why.empty()) ...  // the context is of no use
//
// An error does not end the program any more. A display that is gone does: burr says so in one
// sentence and ends with exit code 74 (Xlib allows nothing else). On other systems than X nothing
// happens. Thread: main.
#pragma once

#include <string>

#include "burr/base/result.h"

struct SDL_Window;

namespace burr::render::gl {

void catch_x_errors();
void forget_x_error();
// "" or what the server has refused since, after waiting for its answers.
[[nodiscard]] std::string x_error(SDL_Window* window);

}  // namespace burr::render::gl
