// report/report_pictures.h - the pictures of a report: the cavity from four sides, and the
// evidence of items.
//
//     auto artist = ReportArtist::make(scored, progress());
//     artist->side(0);                                  // the bone at the end, coloured
//     artist->evidence({3, 5, 8}, 4);                   // of these items, at most four pictures
//
//     map        the spots that a measure looked at, seen by the surgeon
//     region     what is missed of a region, or taken from it
//     moment     the bone and the burr at a tick: from the recorded view, and a section
//     section    a slice through a place
//
// The bone at the end of `scored` moves to the moments of the evidence; it stays at the last of them.
// Drawn without a display. Thread: main. Errors: as render/picture.h.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/aabb.h"
#include "burr/math/vec3.h"
#include "burr/record/view.h"
#include "burr/render/renderer.h"
#include "burr/render/scene.h"
#include "burr/render/slice.h"
#include "burr/report/product_views.h"
#include "burr/report/report.h"
#include "burr/report/scored.h"
#include "burr/surface/worker.h"
#include "burr/workshop/out_piece.h"
#include "burr/workshop/piece_look.h"
#include "burr/workshop/second_tool.h"
#include "burr/workshop/tool_looks.h"

namespace burr::report {

inline constexpr std::size_t kSides = 4;

class ReportArtist {
 public:
  // Keeps `scored` by reference.
  [[nodiscard]] static Result<std::unique_ptr<ReportArtist>> make(Scored& scored,
                                                                  Progress& progress);

  [[nodiscard]] Result<ReportPicture> side(std::size_t which);

  // For a person who must not see what the machine thinks: the bone at the end in the tissues' own colours, from the same
  // four sides, and two sections along each plane through what was removed. Of every session the same. Call it before
  // side().
  struct Plain {
    std::string name;  // "straight", "below", "left", "right", "axial-1" .. "sagittal-2"
    double wide = 0;   // how much it shows from left to right, at its middle [m]
    ReportPicture picture;
  };
  [[nodiscard]] Result<std::vector<Plain>> plain();

  // Of items, by their number in the rubric, most important first. An item has no pictures, one, or
  // two; those for which no room is left have none. Call it once, after side().
  using Pictures = std::map<std::size_t, std::vector<ReportPicture>>;
  [[nodiscard]] Result<Pictures> evidence(std::span<const std::size_t> items, std::size_t most);

 private:
  explicit ReportArtist(Scored& scored);
  using Paint = std::function<volume::TissueId(const surface::Vertex& vertex)>;
  [[nodiscard]] Status skin(Progress& progress);
  [[nodiscard]] bool may_show(std::size_t patch, const metrics::Region& region) const;
  void paint(const Paint& colour, const metrics::Region& region);
  [[nodiscard]] Paint all_of_the_case() const;
  [[nodiscard]] bool is_new(const surface::Vertex& vertex) const;
  void aim(const ProductView& side);
  [[nodiscard]] Result<ReportPicture> drawn(int width, int height, std::string caption);
  [[nodiscard]] Result<ReportPicture> map_of(const std::vector<scoring::Spot>& spots,
                                             std::string caption);
  [[nodiscard]] std::vector<scoring::Spot> faults_in(const metrics::Region& region,
                                                     bool keep) const;
  [[nodiscard]] Result<std::optional<ReportPicture>> still_of(const scoring::Item& item,
                                                              const scoring::Outcome& outcome);
  [[nodiscard]] Result<ReportPicture> section_at(const math::Vec3& at, double ring,
                                                 std::string caption);
  [[nodiscard]] Status moment_of(const scoring::Outcome& outcome, std::size_t room,
                                 std::vector<ReportPicture>& out);

  Scored& scored_;
  math::Vec3 towards_;                         // from the bone to the surgeon
  math::Aabb cavity_;                          // what was removed; empty: nothing
  std::vector<ProductView> sides_;             // and the sections
  render::Scene scene_;                        // of the bone as it is now
  std::vector<surface::Patch> plain_;          // its patches in the tissues' own colours
  std::vector<bool> painted_;                  // of them: in other colours now
  std::optional<workshop::OutPieces> pieces_;  // that were out of the bone
  workshop::PieceLook piece_;
  workshop::ToolLooks looks_;                           // of the tools of the rack
  workshop::SecondTool second_;                         // of the other hand
  volume::TissueId cut_ = 0, missed_ = 0, excess_ = 0;  // colours beyond those of the tissues
  std::vector<record::View> views_;
  std::unique_ptr<surface::Worker> worker_;
  std::unique_ptr<render::Slicer> slicer_;
  std::unique_ptr<render::Renderer> renderer_;
};

// Names and colours of the pictures, "#d55e00".
[[nodiscard]] Legend sides_legend();
[[nodiscard]] Legend spots_legend();

}  // namespace burr::report
