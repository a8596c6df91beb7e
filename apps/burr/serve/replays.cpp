#include "serve/replays.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <utility>

#include "burr/record/bone_blob.h"
#include "burr/record/timeline.h"
#include "burr/report/evidence.h"
#include "burr/report/scored.h"
#include "burr/report/time_line.h"
#include "burr/school/database.h"
#include "burr/school/forget.h"
#include "burr/school/uuid.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "shared/front_words.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

using Json = nlohmann::ordered_json;

// Which content of which file: a file that was written again has another one.
struct Stamp {
  std::uint64_t device = 0, node = 0;
  std::int64_t bytes = 0, seconds = 0, nanoseconds = 0;
  bool operator==(const Stamp& other) const = default;
};

std::optional<Stamp> stamp_of(int descriptor) {
  struct stat about = {};
  if (::fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode)) return std::nullopt;
  return Stamp{about.st_dev, about.st_ino, about.st_size, about.st_mtim.tv_sec,
               about.st_mtim.tv_nsec};
}

class File {
 public:
  // A pipe or a device would wait for ever.
  explicit File(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  [[nodiscard]] std::optional<Stamp> stamp() const {
    return descriptor_ < 0 ? std::nullopt : stamp_of(descriptor_);
  }
  [[nodiscard]] std::string read(std::int64_t from, std::size_t most) const {
    std::string out(most, '\0');
    std::size_t have = 0;
    while (have < most) {
      const ssize_t got = ::pread(descriptor_, out.data() + have, most - have,
                                  static_cast<off_t>(from) + static_cast<off_t>(have));
      if (got <= 0) break;
      have += static_cast<std::size_t>(got);
    }
    out.resize(have);
    return out;
  }

 private:
  int descriptor_;
};

// Three digits behind the point; null: not a number.
Json rounded(const std::vector<float>& values) {
  Json out = Json::array();
  for (const float value : values)
    out.push_back(std::isfinite(value) ? Json(std::round(1e3 * static_cast<double>(value)) / 1e3)
                                       : Json(nullptr));
  return out;
}

Json line_of(const report::ReportLine& line, const scenario::CaseLesson& lesson) {
  Json out = {{"force_n", rounded(line.force_n)},
              {"nearest_mm", rounded(line.nearest_mm)},
              {"farthest_mm", report::kFarthestMm},
              {"cutting", Json::array()},
              {"steps", Json::array()},
              {"events", Json::array()}};
  for (const bool cut : line.cutting) out["cutting"].push_back(cut ? 1 : 0);
  for (const report::ReportLine::Span& step : line.steps) {
    Json say = Json::object();
    if (const scenario::Step* known = lesson.step(step.id))
      for (const auto& [language, text] : known->title.by_language) say[language] = text;
    out["steps"].push_back(
        {{"id", step.id}, {"from_s", step.from_s}, {"to_s", step.to_s}, {"say", say}});
  }
  for (const report::ReportLine::Event& event : line.events)
    out["events"].push_back({{"at_s", event.at_s}, {"kind", event.kind}});
  return out;
}

// What a recording without a score has: the force.
Json line_of(const record::Timeline& line) {
  constexpr std::size_t kParts = 600;
  std::vector<float> force(kParts);
  Json cutting = Json::array();
  for (std::size_t n = 0; n < kParts; ++n) {
    const double from = line.seconds * static_cast<double>(n) / kParts,
                 to = line.seconds * static_cast<double>(n + 1) / kParts;
    force[n] = static_cast<float>(line.force_in(from, to));
    cutting.push_back(std::any_of(line.strokes.begin(), line.strokes.end(),
                                  [&](const record::Stroke& stroke) {
                                    return stroke.begin_s < to && stroke.end_s > from;
                                  })
                          ? 1
                          : 0);
  }
  return {{"force_n", rounded(force)}, {"nearest_mm", nullptr},  {"cutting", cutting},
          {"lost", Json::array()},     {"steps", Json::array()}, {"events", Json::array()}};
}

// The items that are not met, where there is a moment to see it.
Json lost_of(const report::Scored& scored) {
  Json out = Json::array();
  for (std::size_t n = 0; n < scored.judged.rubric.items.size(); ++n) {
    if (scoring::standing_of(scored.score.outcomes[n]) != scoring::Standing::not_met) continue;
    const report::Evidence seen = report::evidence_of(scored, n);
    if (!seen.at_s) continue;
    out.push_back(
        {{"id", scored.judged.rubric.items[n].id}, {"at_s", *seen.at_s}, {"at_end", seen.at_end}});
  }
  return out;
}

struct Made {
  Json line;
  std::vector<std::uint8_t> bone;  // empty: the recording holds it
};

// Of a case with a rubric all of the report's time line, otherwise the force alone.
Result<Made> made_of(const std::string& path, Progress& progress) {
  Made made;
  std::unique_ptr<volume::Bone> before;
  std::unique_ptr<record::Player> player;
  if (auto judged = report::judged_by(path, "")) {
    auto all = report::scored(std::move(*judged), {}, progress);
    if (!all) return all.error();
    made.line = line_of(report::time_line_of(*all), all->judged.lesson);
    made.line["lost"] = lost_of(*all);
    before = std::move(all->before);
    player = std::move(all->judged.player);
  } else {
    auto opened = record::Player::open(path);
    if (!opened) return opened.error();
    player = std::move(*opened);
    auto line = record::timeline_of(*player, progress);
    if (!line) return line.error();
    made.line = line_of(*line);
    auto bone = workshop::bone_of(*player, {}, progress);
    if (!bone) return bone.error();
    before = std::move(*bone);
  }
  made.line["seconds"] = player->seconds();
  made.line["finished"] = player->finished();
  if (!player->info().embedded) made.bone = record::bone_to_blob(*before);
  return made;
}

}  // namespace

struct Replays::Replay final : Progress {
  enum class State { waiting, working, ready, failed };

  std::string session, path, hash;
  std::stop_token stop;
  // below: under Replays::mutex_
  std::mutex* mutex = nullptr;
  State state = State::waiting;
  double share = 0;
  std::string stage, why;
  int status = 500;
  // written before the state is ready, read after
  Stamp stamp;
  std::string line;
  std::string bone;

  void report(double fraction, std::string_view what) override {
    const std::lock_guard lock(*mutex);
    share = fraction;
    stage = what;
  }
  [[nodiscard]] bool cancelled() const override { return stop.stop_requested(); }

  // The sentence: why not.
  [[nodiscard]] Status make() {
    const std::string name = path.substr(path.rfind('/') + 1);
    const File file(path);
    const auto found = file.stamp();
    if (!found) return error(Trouble::usage, name + " is not on this computer, or cannot be read");
    stamp = *found;
    const auto is = school::sha1_of_file(path);
    if (!is) return is.error();
    if (*is != hash)
      return error(Trouble::usage, name +
                                       " has changed since the session came into the store; it "
                                       "is not shown");
    auto made = made_of(path, *this);
    if (!made) return made.error();
    made->line["session"] = session;
    made->line["bytes"] = stamp.bytes;
    made->line["bone_bytes"] = made->bone.size();
    made->line["name"] = name;
    line = json_line(made->line);
    bone.assign(made->bone.begin(), made->bone.end());
    return fine();
  }
};

Replays::Replays() : thread_([this](const std::stop_token& stop) { prepare(stop); }) {}
Replays::~Replays() = default;

void Replays::prepare(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    const auto next = std::find_if(replays_.rbegin(), replays_.rend(), [](const Shared& one) {
      return one->state == Replay::State::waiting;
    });
    if (next == replays_.rend()) {
      changed_.wait(lock, stop, [&] {
        return std::any_of(replays_.begin(), replays_.end(),
                           [](const Shared& one) { return one->state == Replay::State::waiting; });
      });
      continue;
    }
    const Shared replay = *next;
    replay->state = Replay::State::working;
    replay->stop = stop;
    lock.unlock();
    Status done = fine();
    try {
      done = replay->make();
    } catch (const std::exception&
                 trouble) {  // no memory: this session is not shown, the server goes on
      done = error(Trouble::internal, trouble.what());
    }
    lock.lock();
    replay->state = done ? Replay::State::ready : Replay::State::failed;
    if (done) continue;
    replay->why = in_options(done.error()).text;
    replay->status = done.error().trouble == Trouble::io ? 500 : 409;
  }
}

Replays::Shared Replays::replay_of(const std::string& session, const std::string& uri,
                                   const std::string& hash) {
  const std::lock_guard lock(mutex_);
  auto found = std::find_if(replays_.begin(), replays_.end(),
                            [&](const Shared& one) { return one->session == session; });
  if (found != replays_.end()) {
    const Shared there = *found;
    replays_.erase(found);
    replays_.push_back(there);
    return there;
  }
  auto fresh = std::make_shared<Replay>();
  fresh->session = session;
  fresh->path = school::path_of(uri);
  fresh->hash = hash;
  fresh->mutex = &mutex_;
  replays_.push_back(fresh);
  // one that is worked on goes later
  for (auto one = replays_.begin(); replays_.size() > kKept && one != replays_.end();)
    one = (*one)->state == Replay::State::working || *one == fresh ? one + 1 : replays_.erase(one);
  changed_.notify_all();
  return fresh;
}

void Replays::drop(const std::string& session) {
  const std::lock_guard lock(mutex_);
  std::erase_if(replays_, [&](const Shared& one) { return one->session == session; });
}

net::Response Replays::recording(const Replay& replay, const std::string& from) {
  std::int64_t begin = 0;
  const auto [end, trouble] = std::from_chars(from.data(), from.data() + from.size(), begin);
  if (trouble != std::errc() || end != from.data() + from.size() || begin < 0 ||
      begin > replay.stamp.bytes)
    return net::refusal(400, "from: a number of bytes within the recording");
  const File file(replay.path);
  const auto now = file.stamp();
  if (!now || *now != replay.stamp)
    return net::refusal(409, "the recording has changed meanwhile; load the page again");
  net::Response out;
  out.type = "application/octet-stream";
  out.body = file.read(
      begin, std::min<std::size_t>(kMostBytes, static_cast<std::size_t>(now->bytes - begin)));
  return out;
}

net::Response Replays::answer(school::Store& store, const net::Request& request) {
  const std::string session = request.asked("session");
  const auto rows = store.database().rows(
      "SELECT recording_uri, recording_hash FROM session WHERE id = $1", {session});
  if (!rows) return net::refusal(503, in_options(rows.error()).text);
  if (rows->empty()) {
    drop(session);
    return net::refusal(404, "there is no such session");
  }
  const std::string uri = school::text((*rows)[0][0]);
  if (school::path_of(uri).empty())
    return net::refusal(409, uri.empty() ? "the session came in without its recording"
                                         : "the recording is on another computer");
  const Shared replay = replay_of(session, uri, school::text((*rows)[0][1]));
  std::unique_lock lock(mutex_);
  if (replay->state == Replay::State::failed) {
    auto out = net::refusal(replay->status, replay->why);
    lock.unlock();
    drop(session);  // asked for again, it is tried again: the disk may be there then
    return out;
  }
  net::Response out;
  if (replay->state != Replay::State::ready) {
    out.status = 202;
    out.body = json_line(Json{{"share", replay->share}, {"stage", replay->stage}});
    return out;
  }
  lock.unlock();  // what is ready changes no more
  if (request.path == "/api/replay") {
    out.body = replay->line;
    return out;
  }
  if (request.path == "/api/replay/recording") return recording(*replay, request.asked("from"));
  if (request.path == "/api/replay/bone") {
    out.type = "application/octet-stream";
    out.body = replay->bone;
    return out;
  }
  return net::refusal(404, "there is nothing at this address");
}

}  // namespace burr::app
