// apps/burr/window/rate/product_bone.h - a product as a rater sees it in the window: the bone at the end of a session, in
// the tissues' own colours, and the views of report/product_views.h.
//
// Thread: any for open_product() (seconds: for a Loading), then main. Errors: sentences that name no learner and no file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/render/image.h"
#include "burr/render/scene.h"
#include "burr/render/slice.h"
#include "burr/report/product_views.h"
#include "burr/volume/bone.h"

namespace burr::app {

// Members are destroyed in reverse order of declaration; keep this order.
struct ProductBone {
  std::unique_ptr<volume::Bone> bone;
  std::unique_ptr<render::Slicer> slicer;
  render::Scene scene;
  std::vector<report::ProductView> views;

  // A section, in the size of the pictures that the page shows.
  [[nodiscard]] render::Image section(const report::ProductView& view);
};

// recording: as recording_of() found it (school/products.h).
[[nodiscard]] Result<ProductBone> open_product(const std::string& recording, Progress& progress);

}  // namespace burr::app
