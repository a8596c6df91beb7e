#include "serve/stations.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "burr/net/guard.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

using Json = nlohmann::ordered_json;

// What a station says of itself, besides its name.
constexpr const char* kWords[] = {"learner", "case", "mode", "step", "seconds", "force"};
constexpr std::size_t kLongestWord = 120;

net::Response answer_with(const Json& content) {
  net::Response out;
  out.body = json_line(content);
  return out;
}

std::uint64_t number_in(const std::string& text) {
  std::uint64_t out = 0;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

// Letters of UTF-8, not bytes.
std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80;
  }));
}

bool is_jpeg(const std::string& bytes) { return bytes.starts_with("\xFF\xD8\xFF"); }

}  // namespace

net::Response Stations::hear(const net::Request& request, Clock::time_point now) {
  const std::string name = request.asked("name");
  if (name.empty() || letters(name) > kLongestName)
    return net::refusal(400, "name: 1 to 40 letters");
  if (!request.body.empty() && !is_jpeg(request.body))
    return net::refusal(400, "the picture is no JPEG");
  if (!stations_.contains(name) && stations_.size() >= kMost)
    return net::refusal(503, "there are too many stations");
  Station& station = stations_[name];
  station.heard = now;
  for (const char* word : kWords) station.words[word] = request.asked(word).substr(0, kLongestWord);
  if (!request.body.empty()) {
    station.picture = request.body;
    station.number = number_in(request.asked("picture"));
  }
  const std::uint64_t seen = number_in(request.asked("seen"));
  Json out = {{"watched", station.was_watched && now - station.watched < kWatched},
              {"messages", Json::array()}};
  for (Message& one : station.messages) {
    one.seen = one.seen || one.id <= seen;
    if (one.seen) continue;
    Json message = {{"id", one.id}, {"text", one.text}, {"picture", one.picture}};
    if (one.mark) message["mark"] = *one.mark;
    out["messages"].push_back(std::move(message));
  }
  return answer_with(out);
}

net::Response Stations::list() const {
  Json out = {{"stations", Json::array()}};
  for (const auto& [name, station] : stations_) {
    Json one = {{"name", name}};
    for (const auto& [key, word] : station.words) one[key] = word;
    one["messages"] = Json::array();
    for (const Message& message : station.messages)
      one["messages"].push_back({{"id", message.id},
                                 {"text", message.text},
                                 {"marked", message.mark.has_value()},
                                 {"seen", message.seen}});
    out["stations"].push_back(std::move(one));
  }
  return answer_with(out);
}

net::Response Stations::picture(const net::Request& request, Clock::time_point now) {
  const auto found = stations_.find(request.asked("station"));
  if (found == stations_.end()) return net::refusal(404, "there is no such station now");
  Station& station = found->second;
  station.watched = now;
  station.was_watched = true;
  net::Response out;
  if (station.picture.empty() || station.number <= number_in(request.asked("after"))) {
    out.status = 202;
    out.body = "{}";
    return out;
  }
  out.type = "image/jpeg";
  out.body = station.picture;
  out.fields.emplace_back("X-Burr-Picture", std::to_string(station.number));
  return out;
}

net::Response Stations::say(const net::Request& request) {
  const Json said = Json::parse(request.body, nullptr, false);
  if (!said.is_object()) return net::refusal(400, "this is no JSON object");
  const auto text_in = [&](const char* key) {
    const auto found = said.find(key);
    return found != said.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const auto found = stations_.find(text_in("station"));
  if (found == stations_.end()) return net::refusal(404, "there is no such station now");
  Message message;
  message.text = text_in("text");
  if (letters(message.text) > kLongestText) return net::refusal(400, "text: at most 200 letters");
  std::replace_if(
      message.text.begin(), message.text.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
  if (const auto mark = said.find("mark"); mark != said.end() && !mark->is_null()) {
    const auto share = [](const Json& one) {
      return one.is_number() && one.get<double>() >= 0 && one.get<double>() <= 1;
    };
    if (!mark->is_array() || mark->size() != 2 || !share((*mark)[0]) || !share((*mark)[1]))
      return net::refusal(400, "mark: x and y, each 0 to 1");
    message.mark = {(*mark)[0].get<double>(), (*mark)[1].get<double>()};
    const auto number = said.find("picture");
    if (number == said.end() || !number->is_number_unsigned())
      return net::refusal(400, "picture: the number of the picture in which the mark is");
    message.picture = number->get<std::uint64_t>();
  }
  if (message.text.empty() && !message.mark) return net::refusal(400, "say a word, or set a mark");
  message.id = ++last_message_;
  found->second.messages.push_back(message);
  if (found->second.messages.size() > kMostMessages) found->second.messages.pop_front();
  return answer_with({{"id", message.id}});
}

net::Response Stations::answer(const net::Request& request, Clock::time_point now) {
  std::erase_if(stations_, [&](const auto& one) { return now - one.second.heard > kSilent; });
  if (request.path == net::kStationPath) return hear(request, now);
  if (request.path == "/api/live/say")
    return request.method == "POST" ? say(request) : net::refusal(405, "a word is posted");
  if (request.method == "POST") return net::refusal(405, "nothing can be changed here");
  if (request.path == "/api/live") return list();
  if (request.path == "/api/live/picture") return picture(request, now);
  return net::refusal(404, "there is nothing at this address");
}

}  // namespace burr::app
