#include "window/station/station_link.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <utility>

#include "burr/net/client.h"
#include "burr/render/picture.h"

namespace burr::app {
namespace {

constexpr double kWait = 5;                  // for an answer [s]
constexpr std::chrono::seconds kBetween{1};  // words without a picture
constexpr std::chrono::seconds kAfterTrouble{5};
constexpr std::chrono::nanoseconds kPeriod{1'000'000'000 / StationLink::kPerSecond};

std::string jpeg_that_fits(const render::Image& image) {
  for (const int quality : {75, 55, 35, 20}) {
    std::string out = render::jpeg_of(image, quality);
    if (out.size() <= StationLink::kLargestPicture) return out;
  }
  return {};
}

}  // namespace

render::Image smaller(render::Image image, int wide) {
  while (image.width > wide && image.width > 1 && image.height > 1) {
    render::Image half{image.width / 2, image.height / 2, {}};
    half.rgb.resize(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height) *
                    3);
    const auto at = [&](int x, int y, int c) {
      return static_cast<unsigned>(
          image.rgb[(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(x)) *
                        3 +
                    static_cast<std::size_t>(c)]);
    };
    std::size_t n = 0;
    for (int y = 0; y < half.height; ++y)
      for (int x = 0; x < half.width; ++x)
        for (int c = 0; c < 3; ++c)
          half.rgb[n++] = static_cast<std::uint8_t>((at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) +
                                                     at(2 * x, 2 * y + 1, c) +
                                                     at(2 * x + 1, 2 * y + 1, c) + 2) /
                                                    4);
    image = std::move(half);
  }
  return image;
}

Result<std::unique_ptr<StationLink>> StationLink::open(const To& to) {
  const auto url = net::parse_url(to.url);
  if (!url) return error(Trouble::usage, fmt::format("--live {}: {}", to.url, url.error().text));
  if (url->target != "/")
    return error(Trouble::usage,
                 fmt::format("--live {}: only the server's name and port are wanted, for example "
                             "https://school.example:8231",
                             to.url));
  To clean = to;
  while (clean.url.ends_with('/')) clean.url.pop_back();
  return std::unique_ptr<StationLink>(new StationLink(std::move(clean)));
}

StationLink::StationLink(To to)
    : to_(std::move(to)), thread_([this](const std::stop_token& stop) { run(stop); }) {}
StationLink::~StationLink() = default;

void StationLink::is(Words words) {
  const std::lock_guard lock(mutex_);
  words_ = std::move(words);
  known_ = true;
}
bool StationLink::watched() const {
  const std::lock_guard lock(mutex_);
  return watched_;
}
bool StationLink::wants_picture() const {
  const std::lock_guard lock(mutex_);
  return watched_ && !picture_ && std::chrono::steady_clock::now() >= due_;
}
std::uint64_t StationLink::offer(render::Image picture) {
  const std::lock_guard lock(mutex_);
  picture_ = std::move(picture);
  // from the time at which it was due: a window of 35 pictures a second gives 30 of them, not every second one
  due_ = std::max(due_ + kPeriod, std::chrono::steady_clock::now());
  changed_.notify_all();
  return ++number_;
}
std::vector<StationLink::Message> StationLink::news() {
  const std::lock_guard lock(mutex_);
  return std::exchange(news_, {});
}
std::string StationLink::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

// True: it is watched.
Result<bool> StationLink::ask(const Words& words, std::uint64_t number, std::string picture) {
  net::Question question;
  question.method = "POST";
  question.wait_s = kWait;
  question.url = fmt::format(
      "{}/api/station?name={}&picture={}&seen={}&learner={}&case={}&mode={}&step={}&seconds={:.1f}"
      "&force={:.2f}",
      to_.url, net::escaped(to_.name), number, seen_, net::escaped(words.learner),
      net::escaped(words.work), net::escaped(words.mode), net::escaped(words.step), words.seconds,
      words.force);
  question.fields = {{"Authorization", "Bearer " + to_.token}, {"Content-Type", "image/jpeg"}};
  question.body = std::move(picture);
  const auto answer = net::ask(question);
  if (!answer) return answer.error();
  const auto said = nlohmann::json::parse(answer->body, nullptr, false);
  if (answer->status != 200 || !said.is_object())
    return error(Trouble::io,
                 fmt::format("{}: {}", to_.url,
                             said.is_object() ? said.value("error", std::string())
                                              : fmt::format("answer {}", answer->status)));
  const std::lock_guard lock(mutex_);
  for (const auto& one : said.value("messages", nlohmann::json::array())) {
    Message message{one.value("id", std::uint64_t{0}),
                    one.value("text", std::string()),
                    {},
                    one.value("picture", std::uint64_t{0})};
    if (const auto mark = one.find("mark"); mark != one.end())
      message.mark = mark->get<std::array<double, 2>>();
    if (message.id <= seen_) continue;
    seen_ = message.id;
    news_.push_back(std::move(message));
  }
  return said.value("watched", false);
}

void StationLink::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    changed_.wait_for(lock, stop, kBetween, [&] { return picture_.has_value(); });
    if (stop.stop_requested()) return;
    if (!known_) continue;
    const Words words = words_;
    const std::uint64_t number = number_;
    std::optional<render::Image> image = std::exchange(picture_, std::nullopt);
    lock.unlock();
    std::string bytes;
    if (image) bytes = jpeg_that_fits(smaller(std::move(*image), kWide));
    Result<bool> asked = error(Trouble::io, to_.url + ": gave an answer that burr does not know");
    try {
      asked = ask(words, number, std::move(bytes));
    } catch (const nlohmann::json::exception&) {  // another server is at this address
    }
    lock.lock();
    watched_ = asked && *asked;
    trouble_ = asked ? std::string() : asked.error().text;
    if (!asked) changed_.wait_for(lock, stop, kAfterTrouble, [] { return false; });
  }
}

}  // namespace burr::app
