#include "burr/school/pending.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <system_error>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/school/sessions.h"
#include "burr/school/uuid.h"

namespace burr::school {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kLargest = 16U << 20U;  // bytes

Status write(const StorePlace& place, const std::string& name, Json content) {
  std::error_code trouble;
  fs::create_directories(place.pending, trouble);
  content["store"] = shown(place.address);
  auto file = base::NewFile::create((place.pending / name).string(), 0600);
  if (!file) return file.error();
  file->write(content.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  return file->put_in_place();
}

// two recordings of one name, in two folders, both wait
std::string name_of(const WaitingRecording& recording) {
  return uuid_of(kBurrSpace, "file " + recording.file) + ".json";
}

std::string word(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// none: for another store
Result<std::optional<Waiting>> read(const StorePlace& place, const fs::path& file) {
  const std::string name = file.filename().string();
  const auto text = base::text_of_file(file.string(), kLargest, "a session that waits");
  if (!text) return text.error();
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object()) return error(fmt::format("{}: is torn", name));
  if (word(json, "store") != shown(place.address)) return std::optional<Waiting>();
  Waiting one;
  one.file = file;
  if (const auto found = json.find("session"); found != json.end()) {
    auto record = session_from_json(found->dump(), name);
    if (!record) return record.error();
    one.session = std::move(*record);
  } else if (const auto recording = json.find("recording");
             recording != json.end() && recording->is_object()) {
    one.recording = WaitingRecording{word(*recording, "file"), word(*recording, "learner"),
                                     word(*recording, "rubric")};
  } else {
    return error(fmt::format("{}: is no session that waits", name));
  }
  return std::optional<Waiting>(std::move(one));
}

// Refused for good: nothing but another store would take it.
bool is_refused(const Error& error) { return error.trouble == Trouble::usage; }

// True: the session is where it belongs, or was refused; its file can go.
bool settle(Store& store, const SessionRecord& record, TakenIn& in) {
  const auto entered = enter(store, record);
  if (entered) {
    ++in.taken;
    return true;
  }
  if (is_refused(entered.error())) {
    in.notices.push_back(fmt::format("a session that waited was refused and is deleted: {} ({})",
                                     entered.error().text,
                                     base::printable(record.recording_uri, 300)));
    return true;
  }
  ++in.left;
  in.notices.push_back(entered.error().text);
  return false;
}

void take(Store& store, const Waiting& one, const ScoreIt& score, TakenIn& in) {
  std::error_code ignored;
  if (one.session) {
    if (settle(store, *one.session, in)) fs::remove(one.file, ignored);
    return;
  }
  if (!fs::exists(one.recording->file, ignored)) {
    in.notices.push_back(fmt::format("{}: this recording waited for the store and is gone",
                                     base::printable(one.recording->file, 300)));
    fs::remove(one.file, ignored);
    return;
  }
  if (!score) {
    ++in.left;
    return;
  }
  const auto record = score(*one.recording);
  if (!record) {
    // perhaps the bone is on a disk that is not there now; each start says so until the recording is gone
    in.notices.push_back(record.error().text);
    if (is_refused(record.error()))
      fs::remove(one.file, ignored);
    else
      ++in.left;
    return;
  }
  if (settle(store, *record, in)) fs::remove(one.file, ignored);
}

}  // namespace

Status keep(const StorePlace& place, const SessionRecord& record) {
  return write(place, session_id(record) + ".json", {{"session", Json::parse(to_json(record))}});
}

Status keep(const StorePlace& place, const WaitingRecording& recording) {
  return write(
      place, name_of(recording),
      {{"recording",
        {{"file", recording.file}, {"learner", recording.learner}, {"rubric", recording.rubric}}}});
}

void drop(const StorePlace& place, const WaitingRecording& recording) {
  std::error_code ignored;
  fs::remove(place.pending / name_of(recording), ignored);
}

std::vector<Waiting> waiting(const StorePlace& place, std::vector<std::string>& notices) {
  std::vector<fs::path> files;
  std::error_code nobody_asks;
  for (const auto& entry : fs::directory_iterator(place.pending, nobody_asks))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Waiting> all;
  for (const fs::path& file : files) {
    auto one = read(place, file);
    if (one && *one) all.push_back(std::move(**one));
    if (one || !fs::exists(file, nobody_asks)) continue;  // another program took it in
    fs::rename(file, file.string() + ".damaged", nobody_asks);
    notices.push_back(one.error().text + "; it is kept beside as .damaged");
  }
  return all;
}

Result<Kept> enter_or_keep(const StorePlace& place, const SessionRecord& record) {
  Status trouble = fine();
  if (auto store = Store::open(place); store) {
    const auto entered = enter(**store, record);
    if (entered) return Kept{true, ""};
    trouble = entered.error();
  } else {
    trouble = store.error();
  }
  if (is_refused(trouble.error())) return trouble.error();
  if (const Status waits = keep(place, record); !waits)
    return error(Trouble::io, fmt::format("{}; and {}", trouble.error().text, waits.error().text));
  return Kept{false, trouble.error().text};
}

TakenIn take_in(Store& store, const ScoreIt& score) {
  TakenIn in;
  for (const Waiting& one : waiting(store.place(), in.notices)) take(store, one, score, in);
  return in;
}

}  // namespace burr::school
