#include "bench/full_load_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <numeric>
#include <thread>

#include "burr/render/renderer.h"
#include "burr/render/soft_scene.h"
#include "burr/rt/idle_loop.h"
#include "burr/surface/worker.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/work_view.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/recorded_session.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;
using math::Vec3;

constexpr auto kFrame = std::chrono::microseconds(16'667);  // as in the window
constexpr auto kSlowFrame = std::chrono::microseconds(100'000);
constexpr double kLift = 0.3, kBack = 0.3;  // between two pockets [s]
constexpr double kLiftHeight = 5e-3;        // [m]

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Threads that use processor time and caches, like other programs.
class BusyThreads {
 public:
  explicit BusyThreads(int count) {
    for (int i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
  }
  ~BusyThreads() {
    stop_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  BusyThreads(const BusyThreads&) = delete;
  BusyThreads& operator=(const BusyThreads&) = delete;

 private:
  void work() {
    std::vector<std::uint64_t> memory(std::size_t{1} << 20, 1);  // 8 MiB
    std::uint64_t sum = 1;
    while (!stop_.load(std::memory_order_relaxed))
      for (std::size_t i = 0; i < memory.size(); i += 8) sum += memory[i] += sum;
    sink_.fetch_add(sum, std::memory_order_relaxed);
  }
  std::atomic<bool> stop_ = false;
  std::atomic<std::uint64_t> sink_ = 0;
  std::vector<std::thread> threads_;
};

// The picture's part: worker, scene and renderer.
class Picture {
 public:
  static Result<std::unique_ptr<Picture>> make(sim::Session& session,
                                               const surgeon::WorkPlace& place, PictureSize size,
                                               Progress& progress) {
    auto renderer = render::Renderer::offscreen();
    if (!renderer) return renderer.error();
    auto picture = std::unique_ptr<Picture>(new Picture(session, std::move(*renderer)));
    picture->renderer_->resize_offscreen(size.width, size.height);
    const double radius = session.settings().servo.burr.radius;
    picture->scene_ = workshop::scene_of_work(session.bone(), radius, place.at, -place.into);
    picture->scene_.look = {};
    picture->scene_.tissue_colours = render::colours_of(session.bone().tissues());
    if (const Status soft = render::add_soft(picture->scene_, session.bone(), progress); !soft)
      return soft.error();
    const Status skinned = picture->worker_.first(
        progress, [&](const surface::Skin& skin) { workshop::put_skin(picture->scene_, skin); });
    if (!skinned) return skinned.error();
    return picture;
  }

  Status draw(const tick::TickRow& row, WholeOutcome& out) {
    live_.update();
    out.patches += live_.skins().size();
    out.patches_waiting_most = std::max(out.patches_waiting_most, worker_.waiting());
    workshop::put_tool(scene_, row, true);
    ++out.frames;
    const Clock::time_point start = Clock::now();
    const Status shown = renderer_->show(scene_);
    live_.drawn(seconds_since(start), renderer_->figures().redrawn);
    return shown;
  }

 private:
  Picture(sim::Session& session, std::unique_ptr<render::Renderer> renderer)
      : renderer_(std::move(renderer)),
        worker_(session.bone(), 1),
        live_(session, worker_, scene_, renderer_->software()) {}
  std::unique_ptr<render::Renderer> renderer_;
  surface::Worker worker_;
  render::Scene scene_;
  workshop::LiveSurface live_;
};

}  // namespace

double resident_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

double memory_grew_mb(const std::vector<MemoryRow>& rows) {
  const std::size_t fifth = rows.size() / 5;
  if (fifth == 0) return 0;
  const auto mean = [&](std::size_t from) {
    double sum = 0;
    for (std::size_t i = from; i < from + fifth; ++i) sum += rows[i].mb;
    return sum / static_cast<double>(fifth);
  };
  return mean(rows.size() - fifth) - mean(fifth);
}

Result<PocketsAgain> pockets_again(const surgeon::WorkPlace& place, double burr_radius, double each,
                                   double seconds) {
  auto pocket = surgeon::motion("pocket", place, burr_radius, each);
  if (!pocket) return pocket.error();
  PocketsAgain again;
  const Vec3 out = -place.into;
  const double work = pocket->duration();
  again.every = work + kLift + kBack;
  again.lifted = work + kLift;
  const device::PathPoint first = pocket->points.front(), last = pocket->points.back();
  // straight out, to the height at which the pocket's approach begins
  device::PathPoint above = last;
  above.world_from_tool.p +=
      (kLiftHeight - (last.world_from_tool.p - place.at).dot(out) + burr_radius) * out;
  for (double begin = 0; begin < seconds; begin += again.every) {
    for (device::PathPoint point : pocket->points) {
      point.t += begin;
      again.path.points.push_back(point);
    }
    device::PathPoint point = above;
    point.t = begin + work + kLift;
    point.pedal = 0;
    again.path.points.push_back(point);
    point = first;
    point.t = begin + again.every - 1e-3;
    point.pedal = 0;
    again.path.points.push_back(point);
  }
  return again;
}

Result<WholeOutcome> run_whole(sim::Session& session, const surgeon::WorkPlace& place,
                               const scenario::BoneRecipe& volume,
                               const importing::ImportSummary& import, const WholeOptions& options,
                               Progress& progress) {
  WholeOutcome out;
  std::unique_ptr<Picture> picture;
  if (options.picture) {
    auto made = Picture::make(session, place, options.size, progress);
    if (progress.cancelled())
      return error(Trouble::interrupted, "stopped before the session began");
    if (made) {
      picture = std::move(*made);
    } else {
      out.left_out.push_back("no picture was drawn: " + in_options(made.error()).text);
    }
  }
  Recording recording;
  bool records = false;
  if (!options.record.empty()) {
    const Status started =
        recording.start(session, options.record, volume, import, "pockets", false);
    records = started.ok();
    if (!started)
      out.left_out.push_back("nothing was recorded: " + in_options(started.error()).text);
  }

  std::unique_ptr<rt::IdleLoop> waiting;
  if (options.waiting_beside)
    waiting = std::make_unique<rt::IdleLoop>(
        session.settings().servo.rate_hz, rt::ThreadRequest{.name = "waiting", .realtime = true});
  auto busy = std::make_unique<BusyThreads>(options.busy);

  session.start();
  const Clock::time_point start = Clock::now();
  Clock::time_point frame = start, drawn = start;
  const double rate = session.settings().servo.rate_hz;
  double next_memory = 0, next_reset = options.reset_first > 0 ? options.reset_first : 1e300;
  tick::TickRow row;
  Status shown = fine();
  while (session.running() && !interrupted() && seconds_since(start) < options.seconds) {
    static_cast<void>(session.view(row));
    if (static_cast<double>(row.tick) >= next_reset * rate) {
      session.command({tick::CommandKind::reset, 0});
      next_reset += options.reset_every > 0 ? options.reset_every : 1e300;
    }
    if (picture != nullptr && shown) {
      shown = picture->draw(row, out);
      if (!shown) out.left_out.push_back("the picture stopped: " + in_options(shown.error()).text);
      out.longest_frame_s = std::max(out.longest_frame_s, seconds_since(drawn));
      drawn = Clock::now();
    }
    const double now = seconds_since(start);
    if (now >= next_memory) {
      out.memory.push_back({now, resident_mb()});
      next_memory += options.memory_every;
    }
    progress.report(std::min(1.0, now / options.seconds), "milling");
    const auto pause = session.shed() >= tick::Shed::picture ? kSlowFrame : kFrame;
    frame = std::max(frame + pause, Clock::now());
    std::this_thread::sleep_until(frame);
  }
  session.stop();
  progress.report(1, "milling");
  out.memory.push_back({seconds_since(start), resident_mb()});
  busy.reset();
  if (waiting != nullptr) out.waiting = waiting->stop();
  if (records) {
    const Status recorded = recording.finish(session);
    if (!recorded) return recorded.error();
    out.recorded = recording.written();
  }
  out.session = session.outcome();
  if (interrupted()) return error(Trouble::interrupted, "stopped early");
  return out;
}

}  // namespace burr::app
