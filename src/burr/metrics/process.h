// metrics/process.h - all measures of a recording in one pass over its ticks.
//
//     const auto process = process_of(**player, {.critical = {{"facial nerve", &nerve}}}, progress);
//     process->force->restraint
//
// Nothing is allocated per tick beyond what the player needs to decode. What the camera saw comes
// from elsewhere: metrics/visibility.h. Frame: world. Units: SI. Thread: one. Memory: 152 bytes per
// 10 ms of the session, and the marks of the soft structures.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/metrics/dwell.h"
#include "burr/metrics/intact_soft.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/motor_load.h"
#include "burr/metrics/near.h"
#include "burr/metrics/shaft.h"
#include "burr/metrics/smoothness.h"
#include "burr/metrics/solid_contacts.h"
#include "burr/metrics/strokes.h"
#include "burr/metrics/track.h"
#include "burr/metrics/way.h"
#include "burr/record/player.h"
#include "burr/volume/distance_to.h"
#include "burr/volume/grid.h"
#include "burr/volume/tissue.h"

namespace burr::metrics {

// A soft structure that must stay whole. The pointers outlive the pass.
struct SoftStructure {
  std::string name;
  const VoxelSet* voxels = nullptr;
  const volume::DistanceTo* distance = nullptr;
  Worked worked;
  IntactSoftSettings settings = {};
};

// A structure of solid tissue that a turning burr must not touch. The distance outlives the pass.
struct SolidStructure {
  std::string name;
  std::vector<volume::TissueId> tissues = {};
  const volume::DistanceTo* all = nullptr;  // to all solid tissues of the bone
  double voxel = 0;                         // of the bone [m]
};

struct ProcessSettings {
  std::vector<Watched> critical = {};    // what "near" means
  std::vector<SoftStructure> soft = {};  // in the grid of the recording
  std::vector<SolidStructure> solid = {};
  const volume::DistanceTo* bone = nullptr;  // for hesitation; nullptr: not measured
  BurrChoiceSettings choice = {};
};

struct Process {
  Times times;
  Paths paths;
  Assessed<ForceNear> force = NotAssessable{"not measured"};
  std::vector<NearnessOf> nearness;  // one for each critical structure
  Assessed<BurrChoice> choice = NotAssessable{"not measured"};
  struct SoftResult {
    std::string name;
    Assessed<IntactSoft> intact = NotAssessable{"not measured"};
  };
  std::vector<SoftResult> soft;  // one for each soft structure
  struct SolidResult {
    std::string name;
    Assessed<Contacts> contacts = NotAssessable{"not measured"};
  };
  std::vector<SolidResult> solid;                             // one for each solid structure
  Assessed<ShaftRest> shaft = NotAssessable{"not measured"};  // as the session felt it
  Assessed<Dwell> dwell = NotAssessable{"not measured"};
  Assessed<MotorLoad> motor = NotAssessable{"not measured"};
  Track track;
  std::vector<BurrStroke> strokes;
  std::vector<Move> moves;
  std::uint64_t unusable = 0;  // ticks with numbers that are not finite
  double lost_removed = 0;     // removed in gaps of the recording: in no measure [m^3]
};

// Error: interrupted.
[[nodiscard]] Result<Process> process_of(record::Player& player, const ProcessSettings& settings,
                                         Progress& progress);

// The same, tick by tick, for a live session or for made-up ticks.
class ProcessMaker {
 public:
  ProcessMaker(const volume::Grid& grid, double seconds, const ProcessSettings& settings);
  void add(const Moment& now);
  [[nodiscard]] Process finish();

 private:
  Distances distances_;
  TimesMaker times_;
  ForceNearMaker force_;
  NearnessMaker nearness_;
  BurrChoiceMaker choice_;
  ShaftRestMaker shaft_;
  DwellMaker dwell_;
  MotorLoadMaker motor_;
  TrackMaker track_;
  std::vector<std::string> soft_names_;
  std::vector<IntactSoftMaker> soft_;
  std::vector<std::string> solid_names_;
  std::vector<SolidContactsMaker> solid_;
};

}  // namespace burr::metrics
