// apps/burr/window/mill/pinned_labels.h - names of structures that the user pinned: plates at the
// sides of the picture, with a line to the structure, so that they never cover the work.
//
// Thread: main, within a frame of ImGui. Frame: world. Units: m; pixels of the picture.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "burr/render/camera.h"
#include "burr/volume/tissue.h"
#include "window/ui/ui.h"

namespace burr::app {

// Where a plate stands. at: its top left corner.
struct Plate {
  std::size_t pin = 0;  // which of the points
  bool left = false;    // at the left side
  ImVec2 at = {0, 0};
};
struct PlateArea {
  float left = 0, right = 0, top = 0, bottom = 0;
};
// Plates for points of the picture: each at the nearer side, beside its point if there is room, in
// the order of the points' heights, so that lines of one side do not cross. No two overlap, as long
// as the side is high enough for all. widths: of the plates.
[[nodiscard]] std::vector<Plate> plates_for(const std::vector<ImVec2>& points,
                                            const std::vector<float>& widths, float high,
                                            const PlateArea& area);

class PinnedLabels {
 public:
  struct Pin {
    volume::TissueId id = 0;
    math::Vec3 at = math::Vec3::Zero();
  };

  // A tissue has one pin at most: the second call takes it away. True: it is pinned now.
  bool toggle(volume::TissueId id, const math::Vec3& at);
  [[nodiscard]] bool pinned(volume::TissueId id) const;
  [[nodiscard]] bool empty() const { return pins_.empty(); }

  using Name = std::function<std::string(volume::TissueId)>;
  using ColourOf = std::function<ImU32(volume::TissueId)>;
  void draw(const Ui& ui, const render::Camera& camera, const PlateArea& area, const Name& name,
            const ColourOf& colour) const;

 private:
  std::vector<Pin> pins_;
};

}  // namespace burr::app
