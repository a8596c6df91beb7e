// In place of sources that a page does not have: scans from files, and pictures that OpenGL draws.
#include "burr/report/report_pictures.h"
#include "burr/workshop/recording.h"

namespace burr::workshop {

// A recording of the page always holds its bone.
Result<std::unique_ptr<volume::Bone>> bone_of(const record::Player& player,
                                              const scenario::BoneRecipe& /*given*/,
                                              Progress& /*progress*/) {
  return player.embedded_bone();
}

}  // namespace burr::workshop

namespace burr::render {

// There never is one; who could hold one must be able to end it.
struct Renderer::Work {};
Renderer::~Renderer() = default;

}  // namespace burr::render

namespace burr::report {

// No picture is asked for here (ReportSettings::most_pictures is 0): the page brings its own.
Result<std::unique_ptr<ReportArtist>> ReportArtist::make(Scored& /*scored*/,
                                                         Progress& /*progress*/) {
  return error("a page draws no pictures for a report");
}
Result<ReportPicture> ReportArtist::side(std::size_t /*which*/) {
  return error("a page draws no pictures for a report");
}
Result<ReportArtist::Pictures> ReportArtist::evidence(std::span<const std::size_t> /*items*/,
                                                      std::size_t /*most*/) {
  return error("a page draws no pictures for a report");
}

}  // namespace burr::report
