// apps/burr/shared/film_file.h - a film on disk: one file (.mp4), or a folder of numbered pictures.
//
//     auto film = FilmFile::open("s.mp4", {1280, 720}, 25);
//     film->frame(scene);  ...  film->finish();
//
// A file is made by the program ffmpeg, which gets the pixels through a pipe: H.264, 4:2:0, colours
// of BT.709, no times, names or paths inside. It appears under its name only when it is whole.
// Errors: Trouble::usage for an impossible size, Trouble::io if ffmpeg is missing or fails, with what
// to do. Thread: main only (SDL).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/render/picture.h"
#include "burr/render/renderer.h"
#include "burr/render/scene.h"
#include "shared/picture_size.h"

namespace burr::app {

// The part of a recording that a film shows, and how.
struct FilmPlan {
  double from = 0, until = 0;  // [s]
  double fps = 25;
  PictureSize size = {};
  bool one_file = true;  // .mp4; false: pictures

  [[nodiscard]] double seconds() const { return until - from; }
  [[nodiscard]] int frames() const;  // at least 1
  // The moment of a picture, 0 to frames() - 1  [s]
  [[nodiscard]] double moment(int frame) const { return from + frame / fps; }
  // Size on disk [bytes]. A rough estimate, not calibrated: 0.25 bit for each pixel of a .mp4, 5 bits
  // for each of a PNG.
  [[nodiscard]] double bytes() const;
};

// "3.2 MB", "1.4 GB"
[[nodiscard]] std::string in_megabytes(double bytes);

// True: the name ends in .mp4, in upper or lower case; otherwise it is that of a folder.
[[nodiscard]] bool is_film_file(const std::string& path);

// Says in one sentence why there can be no film of this name and size; also if ffmpeg is missing.
[[nodiscard]] Status check_film(const std::string& path, PictureSize size);

class FilmFile {
 public:
  // Pictures of an older film in the folder are overwritten one by one; an older file stays until
  // finish().
  [[nodiscard]] static Result<FilmFile> open(const std::string& path, PictureSize size, double fps);
  FilmFile(FilmFile&&) noexcept;
  FilmFile& operator=(FilmFile&&) noexcept;
  ~FilmFile();  // a file that is not finished is deleted; pictures stay

  Status frame(const render::Scene& scene);
  Status finish();
  [[nodiscard]] int frames() const { return frames_; }

 private:
  class Encoder;
  FilmFile();

  PictureSize size_;
  int frames_ = 0;
  std::optional<render::Film> pictures_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace burr::app
