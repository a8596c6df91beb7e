// dataset/pictures.h - the pictures of a sample: two eyes by burr's renderer, depth and labels by
// raster.h.
//
// Thread: main only (SDL). Memory: a bone, and its surface.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/dataset/layout.h"
#include "burr/dataset/options.h"
#include "burr/dataset/raster.h"
#include "burr/record/player.h"
#include "burr/record/view.h"
#include "burr/render/renderer.h"
#include "burr/render/scene.h"
#include "burr/surface/worker.h"
#include "burr/volume/bone.h"
#include "burr/workshop/out_piece.h"
#include "burr/workshop/piece_look.h"
#include "burr/workshop/second_tool.h"
#include "burr/workshop/tool_looks.h"

namespace burr::dataset {

class Pictures {
 public:
  // The player must outlive this object. Error: no picture can be drawn here, or cancelled.
  [[nodiscard]] static Result<std::unique_ptr<Pictures>> make(record::Player& player,
                                                              const volume::Bone& before,
                                                              const Options& options,
                                                              double field_of_view,
                                                              Progress& progress);

  // t: of the step [s]. What is given back is valid until the next call.
  [[nodiscard]] Result<SamplePictures> draw(double t, const record::Step& step,
                                            const record::View& view);

 private:
  Pictures(record::Player& player, const Options& options, double field_of_view);
  [[nodiscard]] Status set_scene(double t, const record::Step& step);
  [[nodiscard]] Status draw_eye(const record::View& view, double right,
                                std::vector<std::uint8_t>& out);

  record::Player& player_;
  Options options_;
  double field_of_view_;
  std::unique_ptr<volume::Bone> bone_;
  std::unique_ptr<surface::Worker> worker_;
  std::unique_ptr<render::Renderer> renderer_;
  render::Scene scene_;
  workshop::ToolLooks looks_;
  workshop::SecondTool second_;
  workshop::OutPieces pieces_;
  workshop::PieceLook piece_;
  Raster raster_;
  std::vector<std::uint8_t> left_, right_, labels_;
  std::vector<std::uint16_t> depth_;
};

}  // namespace burr::dataset
