#include "shared/identity_options.h"

#include <CLI/CLI.hpp>

#include <string>

namespace burr::app {

void add_identity_options(CLI::App& command, record::Identity& identity) {
  command
      .add_option_function<std::string>(
          "--mode",
          [&identity](const std::string& word) {
            identity.mode = record::mode_of(word).value_or(record::Mode::free);
          },
          "what the session is for, as the recording says it: free, learn, practise or exam "
          "(default: free)")
      ->check([](const std::string& word) {
        return record::mode_of(word) ? std::string() : "must be one of free, learn, practise, exam";
      });
  command
      .add_option("--learner", identity.learner,
                  "pseudonym for the recording, for example kestrel-27; never a name")
      ->check([](const std::string& text) {
        const Status good = record::check_pseudonym(text);
        return good ? std::string() : good.error().text;
      });
  command
      .add_option("--attempt", identity.attempt,
                  "number of the learner's attempt at this case, from 1 (default: not counted)")
      ->check(CLI::Range(1, 100'000));
  command.add_option("--accept-label", identity.accepted_labels,
                     "the recording says that you accept the label of this structure in spite of "
                     "its faults (burr case check); may be repeated");
}

}  // namespace burr::app
