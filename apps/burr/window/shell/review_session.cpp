#include "window/shell/review_session.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "burr/render/camera.h"
#include "shared/word_names.h"
#include "window/replay/playback.h"
#include "window/replay/replay_page.h"
#include "window/ui/loading.h"

namespace burr::app {
namespace {

constexpr double kBefore = 3, kAfter = 1;  // of a moment, are played [s]

// Plays the recording around a moment. The recording stays open for the next one.
class Moments {
 public:
  Moments(Desk& desk, std::string file, std::string folder)
      : desk_(desk), file_(std::move(file)), folder_(std::move(folder)) {}

  Result<Closed> show(const ReviewMoment& moment, std::string& trouble) {
    if (!recorded_) {
      bool closed = false;
      auto opened = load<Recorded>(
          desk_, say(Word::loading, word(Word::start_recording)),
          [this, &moment](Progress& progress) {
            return open_recorded(file_, desk_.places().state, moment.volume, progress);
          },
          closed);
      if (closed) return Closed::window;
      if (!opened) {
        if (opened.error().trouble != Trouble::interrupted) trouble = opened.error().text;
        return Closed::page;
      }
      recorded_ = std::make_unique<Recorded>(std::move(*opened));
    }
    if (moment.place) {                  // as the surgeon looks at it
      constexpr double kHeight = 45e-3;  // of the picture [m]
      recorded_->scene.camera = render::view_of_work(*moment.place, moment.towards, kHeight);
      render::pan(recorded_->scene.camera, 0, -0.1);  // the lower fifth is covered by the strip
    }
    WatchOptions watching;
    watching.folder = folder_;
    watching.from = std::max(0.0, moment.at - kBefore);
    watching.until = moment.at + kAfter;
    watching.place = moment.place;
    watching.note = moment.note;
    return watch(desk_, *recorded_, watching);
  }

 private:
  Desk& desk_;
  const std::string file_, folder_;
  std::unique_ptr<Recorded> recorded_;
};

}  // namespace

Result<Closed> review_session(Desk& desk, ReviewOptions options) {
  Moments moments(desk, options.file, options.folder);
  options.show = [&moments](const ReviewMoment& moment, std::string& trouble) {
    return moments.show(moment, trouble);
  };
  return review(desk, options);
}

}  // namespace burr::app
