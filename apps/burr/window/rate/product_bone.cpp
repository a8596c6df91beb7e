#include "window/rate/product_bone.h"

#include <utility>

#include "burr/render/bone_scene.h"
#include "burr/report/piece_words.h"
#include "burr/report/scored.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"

namespace burr::app {

render::Image ProductBone::section(const report::ProductView& view) {
  render::Image image{2 * report::kViewWide, 2 * report::kViewHigh, {}};
  while (!slicer->draw(*view.slice, image)) {
  }
  return image;
}

// The sentences of the library name the file, whose name may name the learner.
Result<ProductBone> open_product(const std::string& recording, Progress& progress) {
  const auto hidden = [](const Error& why, const char* sentence) {
    return why.trouble == Trouble::interrupted ? why : error(why.trouble, sentence);
  };
  auto judged = report::judged_by(recording, "");
  if (!judged) return hidden(judged.error(), "the recording of this session cannot be read");
  record::Player& player = *judged->player;
  auto before = workshop::bone_of(player, {}, progress);
  if (!before) return hidden(before.error(), "the bone of this session cannot be made");
  ProductBone out;
  out.bone = volume::copy_of(**before);
  // at the end, with moved pieces as they lie
  if (const auto moved = report::moved_pieces_of(player, *out.bone, &judged->lesson); !moved)
    return hidden(moved.error(), "the recording of this session cannot be read");
  out.views =
      report::product_views(report::removed_box(**before, *out.bone),
                            report::towards_surgeon(judged->lesson, judged->work), judged->work.at);
  before->reset();
  if (const Status skinned = render::skin_bone(out.scene, *out.bone, 2, progress); !skinned)
    return hidden(skinned.error(), "the bone of this session cannot be drawn");
  out.slicer = std::make_unique<render::Slicer>(*out.bone);
  out.scene.camera = out.views.front().camera;
  out.scene.burr.visible = false;
  return out;
}

}  // namespace burr::app
