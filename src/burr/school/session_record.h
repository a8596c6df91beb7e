// school/session_record.h - all that the store keeps of one session, as plain data, and as JSON for the folder of what
// waits. No name, no date of birth, no free text.
//
// The id is made from the recording's bytes, so the same recording is the same session whoever enters it, and however
// often. Thread: any.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/seal.h"

namespace burr::school {

// A case or a rubric, by the hash of its text.
struct Defined {
  std::string hash, name, text;
  std::int64_t version = 0;
  std::int64_t calibrated = 0;  // of a rubric: how many of its thresholds were compared with people
  bool operator==(const Defined&) const = default;
};

struct ItemRecord {
  std::string id, result;  // "met", "unmet", "not assessable"
  std::optional<double> value, threshold;
  std::optional<double>
      margin;  // by how much it is met; below 0: by how much it is not. In the unit of the value
  std::string evidence_json;  // one object
  bool operator==(const ItemRecord&) const = default;
};

struct ScoreRecord {
  std::string part;             // "product", "process"
  std::optional<double> total;  // 0..100; none: too little is assessable
  std::int64_t gates_broken = 0;
  double assessable_weight = 0;  // share, 0..1
  std::int64_t made_ms = 0;
  std::vector<ItemRecord> items;
  bool operator==(const ScoreRecord&) const = default;
};

struct MetricRecord {
  std::string name, unit;
  double value = 0;
  bool operator==(const MetricRecord&) const = default;
};

struct SelfMarkRecord {
  std::string item, mark;  // "met", "unmet", "unknown"
  bool operator==(const SelfMarkRecord&) const = default;
};

struct SessionRecord {
  std::string learner;
  Defined work_case, rubric;
  std::string scored_by;        // version of the burr that made the scores
  std::int64_t started_ms = 0;  // since 1970, UTC
  double seconds = 0;
  std::string mode;                    // "free", "learn", "practise", "exam"
  bool guided = false;                 // with help: never part of a curve
  bool finished = false;               // the work was declared done
  std::int64_t attempt = 0;            // as the recording says; 0: it did not count
  std::string device;                  // its name
  std::optional<double> device_max_n;  // its largest force
  double voxel_um = 0;                 // largest edge
  std::string engine;                  // version of the burr that recorded
  std::string recording_hash;          // SHA-1 of the file, 40 digits
  std::string recording_uri;           // file://COMPUTER/path
  // Of a session that was continued: the hashes of its recording as it was before, oldest first.
  std::vector<std::string> goes_on_with = {};
  std::vector<ScoreRecord> scores;
  std::vector<MetricRecord> metrics;
  std::vector<SelfMarkRecord> self_marks;
  // These two are never part of the JSON: whoever can write that file could write them. A session that is believed
  // comes from its recording each time.
  std::optional<Seal> seal = {};
  bool replayed = false;  // simulated again, and every tick and brick was the same
  bool operator==(const SessionRecord&) const = default;
};

// UUID, version 5, of the recording's hash.
[[nodiscard]] std::string session_id(const SessionRecord& record);
[[nodiscard]] std::string score_id(const SessionRecord& record, const ScoreRecord& score);

[[nodiscard]] std::string to_json(const SessionRecord& record);
// Error: not such a text; where: what the sentence begins with.
[[nodiscard]] Result<SessionRecord> session_from_json(std::string_view text,
                                                      const std::string& where);

}  // namespace burr::school
