#include "shared/film_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/base/printable.h"
#include "shared/helper_process.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

constexpr double kBitsPerPixelOfFile = 0.25, kBitsPerPixelOfPicture = 5;

constexpr std::string_view kNoFfmpeg =
    "a film as .mp4 needs the program ffmpeg, which is not installed; install it (Debian: apt "
    "install ffmpeg), or give the name of a folder, for numbered pictures";

}  // namespace

int FilmPlan::frames() const {
  // the picture of the last moment is not shown for a time of its own
  return std::max(1, static_cast<int>(std::floor(seconds() * fps + 1e-6)));
}

double FilmPlan::bytes() const {
  const double pixels = static_cast<double>(size.width) * size.height * frames();
  return pixels * (one_file ? kBitsPerPixelOfFile : kBitsPerPixelOfPicture) / 8;
}

std::string in_megabytes(double bytes) {
  const double mb = bytes / 1e6;
  return mb >= 1000 ? fmt::format("{:.1f} GB", mb / 1000)
                    : fmt::format("{:.{}f} MB", std::max(mb, 0.1), mb < 10 ? 1 : 0);
}

bool is_film_file(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".mp4";
}

Status check_film(const std::string& path, PictureSize size) {
  if (!is_film_file(path)) return fine();
  if (size.width % 2 != 0 || size.height % 2 != 0)
    return error(Trouble::usage,
                 fmt::format("{}: {} x {} pixels: a film as .mp4 has an even number of pixels in "
                             "width and height; use {},{}",
                             base::printable(path), size.width, size.height,
                             size.width + size.width % 2, size.height + size.height % 2));
  if (program_in_path("ffmpeg").empty())
    return error(Trouble::io, fmt::format("{}: {}", base::printable(path), kNoFfmpeg));
  return fine();
}

// ---- ffmpeg

// The program, which reads pixels from a socket and writes the file beside its final place.
class FilmFile::Encoder {
 public:
  static Result<std::unique_ptr<Encoder>> start(const fs::path& path, PictureSize size, double fps);
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder();

  Status write(const std::vector<std::uint8_t>& pixels);
  Status finish();

 private:
  Encoder() = default;
  Error failed();  // waits for the end of ffmpeg
  void end();

  fs::path path_, unfinished_;
  pid_t pid_ = -1;
  int pixels_ = -1, said_at_ = -1, status_ = 0;
};

Result<std::unique_ptr<FilmFile::Encoder>> FilmFile::Encoder::start(const fs::path& path,
                                                                    PictureSize size, double fps) {
  const Status possible = check_film(path.string(), size);
  if (!possible) return possible.error();
  std::unique_ptr<Encoder> made(new Encoder);
  made->path_ = path;
  made->unfinished_ = path.parent_path() / fmt::format(".{}.{}.part", path.filename().string(),
                                                       static_cast<long>(::getpid()));
  // made here, and not by ffmpeg, for this user alone: a film shows how somebody worked
  const int made_first = ::open(made->unfinished_.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
  if (made_first >= 0) ::close(made_first);
  // a socket, because writing to a pipe whose reader is gone raises SIGPIPE; ffmpeg's messages go
  // into memory
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    return error(Trouble::io,
                 path.string() + ": ffmpeg could not be started; close other programs");
  made->pixels_ = ends[0];
  made->said_at_ = ::memfd_create("messages", MFD_CLOEXEC);
  const std::vector<std::string> words = {
      program_in_path("ffmpeg"), "-nostdin", "-hide_banner", "-loglevel", "error", "-y",
      // in: raw pixels
      "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size",
      fmt::format("{}x{}", size.width, size.height), "-framerate", fmt::format("{}", fps), "-i",
      "pipe:0",
      // out: what every player shows
      "-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-colorspace", "bt709",
      "-color_primaries", "bt709", "-color_trc", "bt709", "-c:v", "libx264", "-preset", "medium",
      "-crf", "20", "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact",
      "-movflags", "+faststart", "-f", "mp4", fs::absolute(made->unfinished_).string()};
  std::vector<char*> arguments;
  for (const std::string& each : words) arguments.push_back(const_cast<char*>(each.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
  ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  if (made->said_at_ >= 0) ::posix_spawn_file_actions_adddup2(&actions, made->said_at_, 2);
  posix_spawnattr_t attributes;  // a group of its own: Ctrl-C is for burr, which then ends ffmpeg
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  const int failed = ::posix_spawn(&made->pid_, words.front().c_str(), &actions, &attributes,
                                   arguments.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (failed != 0) {
    made->pid_ = -1;
    return error(Trouble::io,
                 path.string() + ": ffmpeg could not be started; close other programs");
  }
  return made;
}

FilmFile::Encoder::~Encoder() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    end();
  }
  if (pixels_ >= 0) ::close(pixels_);
  if (said_at_ >= 0) ::close(said_at_);
  std::error_code nobody_asks;
  if (!unfinished_.empty()) fs::remove(unfinished_, nobody_asks);
}

void FilmFile::Encoder::end() {
  if (pixels_ >= 0) ::close(std::exchange(pixels_, -1));
  while (pid_ > 0 && ::waitpid(pid_, &status_, 0) < 0 && errno == EINTR) continue;
  pid_ = -1;
}

Error FilmFile::Encoder::failed() {
  end();
  std::string said(4096, '\0');
  const ssize_t got = said_at_ >= 0 ? ::pread(said_at_, said.data(), said.size(), 0) : 0;
  said.resize(static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  said.erase(std::min(said.find('\n'), said.size()));
  return error(Trouble::io,
               fmt::format("{}: ffmpeg made no film: {}; give the name of a folder, for numbered "
                           "pictures",
                           base::printable(path_.string()),
                           said.empty() ? "it ended early" : base::printable(said)));
}

Status FilmFile::Encoder::write(const std::vector<std::uint8_t>& pixels) {
  for (std::size_t done = 0; done < pixels.size();) {
    const ssize_t some = ::send(pixels_, pixels.data() + done, pixels.size() - done, MSG_NOSIGNAL);
    if (some < 0 && errno == EINTR) continue;
    if (some <= 0) return failed();
    done += static_cast<std::size_t>(some);
  }
  return fine();
}

Status FilmFile::Encoder::finish() {
  end();
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) return failed();
  std::error_code trouble;
  fs::rename(unfinished_, path_, trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot be written: {}",
                                          base::printable(path_.string()), trouble.message()));
  unfinished_.clear();
  return fine();
}

// ---- either kind

FilmFile::FilmFile() = default;
FilmFile::FilmFile(FilmFile&&) noexcept = default;
FilmFile& FilmFile::operator=(FilmFile&&) noexcept = default;
FilmFile::~FilmFile() = default;

Result<FilmFile> FilmFile::open(const std::string& path, PictureSize size, double fps) {
  FilmFile film;
  film.size_ = size;
  if (!is_film_file(path)) {
    auto pictures = render::Film::in(path, size.width, size.height);
    if (!pictures) return pictures.error();
    film.pictures_.emplace(std::move(*pictures));
    return film;
  }
  auto encoder = Encoder::start(path, size, fps);
  if (!encoder) return encoder.error();
  film.encoder_ = std::move(*encoder);
  auto renderer = render::Renderer::offscreen();
  if (!renderer) return renderer.error();
  film.renderer_ = std::move(*renderer);
  return film;
}

Status FilmFile::frame(const render::Scene& scene) {
  if (pictures_) {
    const Status written = pictures_->frame(scene);
    if (written) ++frames_;
    return written;
  }
  const auto image = renderer_->image(scene, size_.width, size_.height);
  if (!image) return image.error();
  const Status written = encoder_->write(image->rgb);
  if (written) ++frames_;
  return written;
}

Status FilmFile::finish() { return encoder_ ? encoder_->finish() : fine(); }

}  // namespace burr::app
