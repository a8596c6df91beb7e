#include "burr/school/pending.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <iterator>
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
  auto file = base::NewFile::create((place.pending / name).string());
  if (!file) return file.error();
  file->write(content.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  return file->put_in_place();
}

// Two recordings of one name, in two folders, both wait; and one session for each of two servers, which share a folder.
std::string name_of(const StorePlace& place, const std::string& what) {
  return uuid_of(kBurrSpace, shown(place.address) + " " + what) + ".json";
}
std::string name_of(const StorePlace& place, const WaitingRecording& recording) {
  return name_of(place, "file " + recording.file);
}

// Older ones may say the same file by another way.
bool is_of(const StorePlace& place, const std::string& store) {
  const std::string here = shown(place.address);
  if (store == here) return true;
  std::error_code trouble;
  return store.find("://") == std::string::npos && fs::path(store).is_absolute() &&
         fs::weakly_canonical(store, trouble).string() == here;
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
  if (!is_of(place, word(json, "store"))) return std::optional<Waiting>();
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

std::optional<std::string> bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file.is_open() || file.bad()) return std::nullopt;
  return bytes;
}

// "kestrel-2" is not in "kestrel-27".
bool holds_word(const std::string& text, const std::string& word) {
  const auto is_of_word = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_of_word(text[at - 1])) && (end == text.size() || !is_of_word(text[end])))
      return true;
  }
  return false;
}

const std::string& whose(const Waiting& one) {
  return one.session ? one.session->learner : one.recording->learner;
}

// Refused for good: nothing but another store would take it.
bool is_refused(const Error& error) { return error.trouble == Trouble::usage; }

// False: gone from a folder that is there. A disk that is away, or that cannot be asked, has its recordings still.
bool may_be_there(const fs::path& file) {
  std::error_code trouble;
  if (fs::exists(file, trouble) || trouble) return true;
  return !fs::exists(file.parent_path(), trouble) || trouble;
}

// True: the session is where it belongs, or was refused; its file can go. away: the store cannot be written now.
bool settle(Store& store, const SessionRecord& record, TakenIn& in, bool& away) {
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
  away = entered.error().trouble == Trouble::io;
  in.notices.push_back(entered.error().text);
  return false;
}

void take(Store& store, const Waiting& one, const ScoreIt& score, TakenIn& in, bool& away) {
  std::error_code ignored;
  if (one.session) {
    if (settle(store, *one.session, in, away)) fs::remove(one.file, ignored);
    return;
  }
  if (!may_be_there(one.recording->file)) {
    in.notices.push_back(fmt::format("{}: this recording waited for the store and is gone",
                                     base::printable(one.recording->file, 300)));
    fs::remove(one.file, ignored);
    return;
  }
  if (!fs::exists(one.recording->file, ignored)) {
    ++in.left;
    in.notices.push_back(
        fmt::format("{}: the folder of this recording is not there now; it goes on waiting",
                    base::printable(one.recording->file, 300)));
    return;
  }
  if (!score) {
    ++in.left;
    ++in.unscored;
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
  if (settle(store, *record, in, away)) fs::remove(one.file, ignored);
}

}  // namespace

Status keep(const StorePlace& place, const SessionRecord& record) {
  return write(place, name_of(place, "session " + session_id(record)),
               {{"session", Json::parse(to_json(record))}});
}

Status keep(const StorePlace& place, const WaitingRecording& recording) {
  return write(
      place, name_of(place, recording),
      {{"recording",
        {{"file", recording.file}, {"learner", recording.learner}, {"rubric", recording.rubric}}}});
}

void drop(const StorePlace& place, const WaitingRecording& recording) {
  std::error_code ignored;
  fs::remove(place.pending / name_of(place, recording), ignored);
}

std::vector<Waiting> waiting(const StorePlace& place, std::vector<std::string>& notices,
                             std::size_t* others) {
  std::vector<fs::path> files;
  std::error_code nobody_asks;
  for (const auto& entry : fs::directory_iterator(place.pending, nobody_asks))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Waiting> all;
  for (const fs::path& file : files) {
    auto one = read(place, file);
    if (one && *one) all.push_back(std::move(**one));
    if (one && !*one && others != nullptr) ++*others;
    if (one || !fs::exists(file, nobody_asks)) continue;  // another program took it in
    fs::rename(file, file.string() + ".damaged", nobody_asks);
    notices.push_back(one.error().text + "; it is kept beside as .damaged");
  }
  return all;
}

Leftovers leftovers(const StorePlace& place, const std::string& learner) {
  Leftovers found;
  std::error_code trouble;
  for (const auto& entry : fs::directory_iterator(place.pending, trouble)) {
    std::error_code nobody_asks;
    if (!entry.is_regular_file(nobody_asks)) continue;
    // of another store, whose learner of this name may be another person; or of another learner, in a folder of that name
    if (const auto whole = read(place, entry.path());
        whole && (!*whole || whose(**whole) != learner))
      continue;
    const auto text = bytes_of(entry.path());
    if (!text)
      found.unread.push_back(entry.path());
    else if (holds_word(*text, learner))
      found.holding.push_back(entry.path());
  }
  if (trouble && trouble != std::errc::no_such_file_or_directory)
    found.unread.push_back(place.pending);
  return found;
}

Result<Kept> enter_or_keep(const StorePlace& place, const SessionRecord& record,
                           const WaitingRecording& from) {
  Status trouble = fine();
  if (auto store = Store::open(place); store) {
    const auto entered = enter(**store, record);
    if (entered) return Kept{true, "", entered->standing};
    trouble = entered.error();
  } else {
    trouble = store.error();
  }
  if (is_refused(trouble.error())) return trouble.error();
  const bool sealed = record.seal && !from.file.empty();
  if (const Status waits = sealed ? keep(place, from) : keep(place, record); !waits)
    return error(Trouble::io, fmt::format("{}; and {}", trouble.error().text, waits.error().text));
  return Kept{false, trouble.error().text};
}

TakenIn take_in(Store& store, const ScoreIt& score) {
  TakenIn in;
  bool away = false;
  for (const Waiting& one : waiting(store.place(), in.notices, &in.others)) {
    if (away)
      ++in.left;
    else
      take(store, one, score, in, away);
  }
  return in;
}

}  // namespace burr::school
