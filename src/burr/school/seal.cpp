#include "burr/school/seal.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <map>

#include "burr/base/printable.h"
#include "burr/record/sealer.h"
#include "burr/school/signing_key.h"

namespace burr::school {
namespace {

std::string about_words(const Seal& seal) {
  return fmt::format(
      "station {}\nnonce {}\ngiven_ms {}\nlearner {}\nmode {}\ncase {}\nrubric {}\nbone {}\n"
      "device {}\n",
      seal.station, seal.nonce, seal.given_ms, seal.learner, seal.mode, seal.case_hash,
      seal.rubric_hash, seal.bone_hash, seal.device);
}

std::string word(const std::map<std::string, std::string>& words, const char* name) {
  const auto found = words.find(name);
  return found != words.end() ? found->second : std::string();
}

Error refused(const std::string& file, const std::string& why) {
  return error(Trouble::usage,
               fmt::format("{}: {}; use the original file",
                           base::printable(std::filesystem::path(file).filename().string()), why));
}

}  // namespace

std::string start_words(const Seal& seal) { return "burr seal start 1\n" + about_words(seal); }

std::string end_words(const Seal& seal) {
  return fmt::format("burr seal end 1\n{}start {}\nended_ms {}\nhead {}\n", about_words(seal),
                     seal.start_signature, seal.ended_ms, seal.head);
}

Seal seal_about(const record::SessionInfo& info) {
  Seal seal;
  const record::Identity identity = info.identity.value_or(record::Identity());
  seal.learner = identity.learner;
  seal.mode = record::word_of(identity.mode);
  seal.case_hash = record::hex(identity.case_hash);
  seal.rubric_hash = record::hex(identity.rubric_hash);
  seal.bone_hash = record::hex(info.volume.content_hash);
  if (const auto device = info.words.find("device"); device != info.words.end())
    seal.device = device->second;
  return seal;
}

Result<std::optional<Seal>> seal_of(const std::string& file, const record::SessionInfo& info) {
  const auto end = record::seal_in(file);
  if (!end) return error(Trouble::usage, end.error().text);
  if (!info.seal && !*end) return std::optional<Seal>();
  if (!info.seal)
    return refused(file,
                   "it has a seal of its end and none of its start, so the seal in /session was "
                   "taken out");
  Seal seal = seal_about(info);
  seal.station = info.seal->station;
  seal.nonce = info.seal->nonce;
  seal.given_ms = info.seal->given_ms;
  seal.start_signature = info.seal->signature;
  if (!*end) return std::optional<Seal>(seal);
  const std::map<std::string, std::string>& words = (*end)->words;
  if (word(words, "station") != seal.station || word(words, "nonce") != seal.nonce)
    return refused(file, "the seal of its end is that of another session, by its nonce or station");
  const auto head = sha256_of_beginning(file, (*end)->bytes);
  if (!head) return head.error();
  seal.head = word(words, "head");
  if (seal.head != *head)
    return refused(file,
                   "it is not what was sealed, so it was changed afterwards: its bytes do not give "
                   "the head in the metadata burr.seal");
  const std::string ended = word(words, "ended_ms");
  const auto read = std::from_chars(ended.data(), ended.data() + ended.size(), seal.ended_ms);
  seal.signature = word(words, "signature");
  if (read.ec != std::errc() || read.ptr != ended.data() + ended.size() || seal.signature.empty())
    return refused(file, "the metadata burr.seal lacks its ended_ms or its signature");
  return std::optional<Seal>(seal);
}

bool is_persons_hand(const std::string& device) {
  return !device.empty() && device != "simulated hand";
}

}  // namespace burr::school
