// apps/burr/window/mill/structures.h - the structures of a bone by name: what lies under the
// pointer, how far the burr is from each, and which of them see-through bone hides.
//
//     Structures structures(bone, lesson, work_case);          // before the session starts
//     if (const auto seen = structures.under(scene, ray)) say(structures.name(seen->id));
//
// A name is burr's translation of a name that it knows (anatomy.h), else the one in the bone. Thread: main. Frame: world. Units: m.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/render/pick.h"
#include "burr/render/scene.h"
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "window/mill/structure_map.h"

namespace burr::app {

class Structures {
 public:
  struct Row {
    volume::TissueId id = 0;
    volume::TissueKind kind = volume::TissueKind::solid;
    bool spare = false;              // must not be cut
    bool hidden = false;             // in see-through bone
    std::optional<double> distance;  // from the burr's surface; none: not measured [m]
  };
  struct Seen {
    volume::TissueId id = 0;
    math::Vec3 at = math::Vec3::Zero();
  };

  // lesson, work_case: of the case, for what must be spared; nullptr: none. Read only here.
  Structures(const volume::Bone& bone, const scenario::CaseLesson* lesson,
             const scenario::Case* work_case);

  // What must be spared comes first, then soft tissue, solid tissue, air spaces with a name.
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  // In the language of the user.
  [[nodiscard]] std::string name(volume::TissueId id) const;
  [[nodiscard]] const volume::Tissue& tissue(volume::TissueId id) const {
    return bone_.tissues()[id];
  }
  [[nodiscard]] std::optional<math::Vec3> place(volume::TissueId id) const {
    return map_.place(id);
  }

  // Measures the distance to each structure that is soft or to be spared.
  void measure(const math::Vec3& tip, double radius);

  // Only soft tissue can be hidden: it is what one sees through the bone.
  void toggle(volume::TissueId id);
  // Marks hidden tissues in the colours of a scene (Scene::tissue_colours).
  void hide_in(std::vector<render::Colour>& colours) const;

  // What the user sees along the ray: soft tissue that lies open, or behind transparent bone and not
  // hidden; otherwise the tissue of the bone's surface. None: the ray meets no bone.
  [[nodiscard]] std::optional<Seen> under(const render::Scene& scene, const render::Ray& ray) const;
  // What is at a point now: 0 is air without a name, also where solid tissue was cut away.
  [[nodiscard]] volume::TissueId at(const math::Vec3& p) const;

 private:
  [[nodiscard]] volume::TissueId label(const math::Vec3& p) const;
  [[nodiscard]] bool is_soft(volume::TissueId id) const {
    return bone_.tissues()[id].kind == volume::TissueKind::soft;
  }
  [[nodiscard]] bool hidden(volume::TissueId id) const;

  const volume::Bone& bone_;
  std::vector<Row> rows_;
  StructureMap map_;
};

}  // namespace burr::app
