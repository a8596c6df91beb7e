// What the user saw and did: the channels /view and /course.
#include <fmt/core.h>

#include <algorithm>

#include "burr/record/player.h"

namespace burr::record {

void Player::read_course() {
  std::size_t unknown = 0;
  for (const std::size_t c : chunks_with(course_channels_)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) continue;  // find_holes() says so
    for (const McapMessage& message : chunk->messages) {
      if (!course_channels_.contains(message.channel)) continue;
      CourseEvent event;
      if (course_from_json(as_text(message.data), event))
        course_.push_back(std::move(event));
      else
        ++unknown;
    }
  }
  std::stable_sort(course_.begin(), course_.end(),
                   [](const auto& a, const auto& b) { return a.tick < b.tick; });
  if (unknown > 0)
    notice(
        fmt::format("{}: {} events of the course are unknown and were ignored; they were perhaps "
                    "recorded by a newer burr",
                    path_, unknown));
}

// Where the session was continued it had not ended.
std::optional<Ending> Player::ending() const {
  std::optional<Ending> ending;
  for (const CourseEvent& event : course_) {
    if (event.kind == CourseKind::ended) ending = ending_of(event.value);
    if (event.kind == CourseKind::continued) ending.reset();
  }
  return ending;
}

std::vector<View> Player::views() {
  std::vector<View> all;
  std::size_t unknown = 0;
  for (const std::size_t c : chunks_with(view_channels_)) {
    const auto chunk = reader_->read_chunk(c);
    if (!chunk) continue;  // find_holes() has said so
    for (const McapMessage& message : chunk->messages) {
      if (!view_channels_.contains(message.channel)) continue;
      View view;
      if (view_from_json(as_text(message.data), view))
        all.push_back(view);
      else
        ++unknown;
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const View& a, const View& b) { return a.tick < b.tick; });
  if (unknown > 0)
    notice(fmt::format("{}: {} views are not valid and were ignored", path_, unknown));
  return all;
}

std::string Player::lacks() const {
  std::string list;
  const auto add = [&list](bool missing, const char* what) {
    if (missing) list += (list.empty() ? "" : ", ") + std::string(what);
  };
  add(view_channels_.empty(), "what the user saw");
  add(!has_course(), "steps, help, warnings and how the session ended");
  add(!info_.identity, "mode, learner and attempt");
  add(!info_.shaft, "the size of the shaft");
  if (list.empty()) return {};
  return fmt::format(
      "{}: the recording does not hold {}; an older burr, or another program, wrote it", path_,
      list);
}

}  // namespace burr::record
