#include "commands/examples.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

namespace burr::app {
namespace {

struct Example {
  std::string_view command;  // "bench tick"; the line begins with it
  std::string_view rest;     // what follows the command
  std::string_view help;
};

// Several lines of one command stand together, the simplest first.
constexpr std::array kExamples = std::to_array<Example>({
    {"run", "", "the start page"},
    {"run", "temporal-bone", "straight to a case"},
    {"run", "ct_folder/ --iso 450", "a scan of your own, bone from 450 HU on"},
    {"run", "temporal-bone --device touch", "with a haptic device"},
    {"run", "jaw --headless --out cut", "no window: pictures, a recording, figures"},
    {"info", "ct_folder/", "what the scan holds, and the bone burr would make"},
    {"info", "head.nrrd --voxel-mm 0.3 --json", "for another program"},
    {"info", "s.mcap", "what a recording holds"},
    {"picture", "temporal-bone.nrrd --out bone.png", "the bone"},
    {"picture", "phantom:jaw --view coronal --out slice.png", "a slice"},
    {"picture", "ct_folder/ --view axial --greys 4000,700 --out grey.png",
     "with the scan's values"},
    {"mill", "phantom:block --motion slot --burr-mm 4 --picture after.png", "a slot"},
    {"mill", "ct_folder/ --motion pocket --burr-mm 5 --record s.mcap --json", "recorded"},
    {"mill", "phantom:block --motion plunge --removal chips --torque-mnm 2", "teeth that stall"},
    {"replay", "s.mcap --check", "simulate it again and compare every tick"},
    {"replay", "s.mcap --film s.mp4 --from 10 --until 40", "half a minute as a film"},
    {"replay", "s.mcap --film frames --fps 5", "as numbered pictures"},
    {"replay", "s.mcap --window --beside expert.mcap", "two sessions, compared"},
    {"replay", "s.mcap --at 12.5 --effects --picture p.png", "one moment"},
    {"verify", "--quick", "within a minute"},
    {"verify", "heat friction --out v", "two parts, with a report"},
    {"verify law", "hardening.so --law-settings hardening.txt", "before a session in real time"},
    {"verify law", "my_law.so --out v", "with a report"},
    {"psychophysics", "stiffness --observer threshold=0.12,feels=yes --out p",
     "a simulated person"},
    {"psychophysics", "friction --device touch --subject p07 --out p07", "a person"},
    {"export", "s.mcap --part bone --out bone.stl", "a mesh to print"},
    {"export", "s.mcap --part removed --frame print --out removed.3mf", "what was removed"},
    {"export", "s.mcap --part pieces --out piece.stl", "each piece that came free, by itself"},
    {"export", "s.mcap --part dataset --out s.hdf5", "the session for programs that learn"},
    {"export", "s.mcap --part dataset --out s.hdf5 --images 640x480 --fps 10", "with pictures"},
    {"export", "ct_folder/ --out bone.seg.nrrd", "a scan as labels"},
    {"pieces", "s.mcap", "where free pieces were moved, and how they fit"},
    {"pieces", "s.mcap --at 12.5 --json", "at 12.5 s, for another program"},
    {"phantom", "temporal-bone --voxel-mm 0.25 --out bone.seg.nrrd", "with its structures"},
    {"phantom", "jaw --landmarks", "the points that the formula knows"},
    {"learner add", "--level PGY2 --retain-until 2028-12-31", "a pseudonym of burr's making"},
    {"learner enter", "kestrel-27 s.mcap", "a recording becomes a session"},
    {"learner export", "kestrel-27 --out k.zip", "all that is known of one learner"},
    {"learner export", "--all --csv tables", "for statistics, without names"},
    {"learner list", "", "who practised, and how often"},
    {"learner list", "kestrel-27 --json", "the sessions of one, for another program"},
    {"learner list", "--store postgresql://burr@db.example.org/school", "on a centre's server"},
    {"learner forget", "kestrel-27", "with all sessions and recordings"},
    {"learner forget", "--overdue", "all whose time to keep is over"},
    {"learner take-in", "", "what waited for the store"},
    {"learner audit", "", "every line"},
    {"learner xapi", "status", "see `burr learner xapi on --help`"},
    {"learner xapi on", "--home-page https://centre.example.org", "for all stations of the store"},
    {"learner xapi off", "", "what waited stays"},
    {"learner xapi status", "", "what waits, and what the server refused"},
    {"learner xapi send", "--now", "at once, whatever it waits for"},
    {"learner xapi send", "--for 3600", "goes on for an hour"},
    {"learner xapi retry", "", "after the server was mended"},
    {"learner xapi test", "--key-file lrs.txt", "does it take the key?"},
    {"learner decide", "kestrel-27", "what the centre's standards propose"},
    {"learner decide", "kestrel-27 --standard 5f0c --outcome pass --reason \"as proposed\"",
     "a person decides, whose key or login says who it is"},
    {"learner check", "", "are the audit, the seals and the decisions as they were written?"},
    {"station", "enrol station-3", "see `burr station enrol --help`"},
    {"station enrol", "station-3", "this computer seals the sessions of its learners from now on"},
    {"station enrol", "a-berg --decides", "your key for decisions"},
    {"station list", "", "which seals the store believes"},
    {"station revoke", "station-3", "a station was stolen: no new seal of it is believed"},
    {"rate", "--rater \"A. Berg\"", "what is left to mark"},
    {"rate", "--rater \"A. Berg\" --from marks.csv", "many marks at once"},
    {"learner cohort list", "", "the groups and who is in them"},
    {"learner cohort remove", "\"autumn 2026\" otter-512", "one leaves"},
    {"learner", "add --level student", "see `burr learner add --help`"},
    {"learner cohort", "list", "see `burr learner cohort add --help`"},
    {"learner cohort add", "\"autumn 2026\" kestrel-27 otter-512", "a class"},
    {"repair", "s.mcap", "in place"},
    {"repair", "s.mcap --out whole.mcap", "leaves s.mcap as it is"},
    {"settings", "", "what `burr mill` takes"},
    {"settings", "--markdown", "the whole table, as docs/use/settings.md"},
    {"materials", "", "the built-in table"},
    {"materials", "--materials mine.toml --json", "with your own values"},
    {"tools", "", "the built-in rack"},
    {"tools", "--tools mine.toml --picture tools.png", "with your own, as a picture"},
    {"fit", "force.csv --out mine.toml", "constants from a force log"},
    {"fit", "a.mcap b.mcap --material femur", "from recordings"},
    {"case check", "temporal-bone", "a built-in case"},
    {"case check", "mine.toml --accept-label \"facial nerve\"", "in spite of a label's fault"},
    {"case new", "head.seg.nrrd --out mine.toml", "burr asks for the rest"},
    {"surgeon", "tooth --level average --seed 3 --record s.mcap", "a session to score"},
    {"surgeon", "jaw --vice force_N=4 --json", "an expert who presses too hard"},
    {"batch", "--manifest m.csv --out run1", "all rows, one after the other"},
    {"batch", "--manifest m.csv --shard 3/64 --out run1", "those of one part of 64"},
    {"batch", "--manifest m.csv --dry-run", "what would fail, and how much memory a row needs"},
    {"merge", "run1 --manifest m.csv --out r.csv", "one table"},
    {"merge", "run1 --manifest m.csv --out r.csv --sqlite r.sqlite", "and a database"},
    {"score", "s.mcap", "by the rubric of its case"},
    {"score", "s.mcap --rubric mine.toml --json", "by your own"},
    {"rubric check", "temporal-bone", "a built-in rubric"},
    {"rubric check", "mine.toml --case jaw", "your own"},
    {"report", "s.mcap --out s.html", "one page"},
    {"report", "s.mcap --out s.html --self marks.toml --beside expert.mcap --language sv",
     "with your own marks and an expert"},
    {"compare", "a.mcap b.mcap", "in the terminal"},
    {"compare", "a.mcap b.mcap --out both.html", "as a page with pictures"},
    {"serve", "", "on this computer, port 8231"},
    {"serve", "--live", "running stations can be watched"},
    {"serve", "--store postgresql://school.example/school --port 9000", "a centre's database"},
    {"study reliability", "marks.csv --marks 5", "how far marks would be the same again"},
    {"study standard", "groups.csv --method contrasting", "where a cut may lie"},
    {"study standard", "--store --low PGY1,PGY2 --high surgeon", "from the store"},
    {"study standards", "--store", "those that the centre has set"},
    {"study raters", "ratings.csv", "two raters, or raters and the machine"},
    {"study curve", "marks.csv --json", "with the 95 % band of each curve"},
    {"study raters", "--store", "from the store of learners"},
    {"web", "--out page", "burr in a browser, for any web server"},
    {"web", "--out page --from burr-web-0.1.0.tar.gz", "of an archive"},
    {"doctor", "", "look at everything"},
    {"doctor", "--fix", "write the udev rule"},
    {"check", "", "12 seconds"},
    {"check", "--seconds 60 --no-picture", "longer, without a picture"},
    {"bench tick", "--mill slot --ticks 10000", "milling a slot"},
    {"bench tool", "--tool sagittal-saw --scene slot --mill", "a saw in its slot"},
    {"bench piece", "--kerf-mm 0.5 --ticks 5000", "a narrow kerf"},
    {"bench methods", "--size 128 --json", "all methods of touch"},
    {"bench surface", "--size 256 --runs 3", "a smaller shell"},
    {"bench carve", "--cuts 500", "fewer cuts"},
    {"bench load", "ct_folder/", "your own scan"},
    {"bench memory", "phantom:temporal-bone", "a synthetic bone"},
    {"bench endure", "--seconds 60", "a minute"},
    {"bench frame", "phantom:jaw --picture-size 1920,1080", "at the size of your screen"},
    {"bench device", "--device touch", "your device"},
    {"devices", "", "list them"},
    {"devices set", "touch scale=0.5 max_force_n=2", "finer work, less force"},
    {"devices test", "touch --out test.html", "with a page"},
    {"arm", "temporal-bone", "until Ctrl-C"},
    {"arm", "jaw --name /psm1 --domain 7 --record s.mcap", "another name, recorded"},
    {"help", "mill", "the help of a command"},
    {"case", "check temporal-bone", "see `burr case check --help`"},
    {"rubric", "check jaw", "see `burr rubric check --help`"},
    {"study", "reliability marks.csv", "see `burr study reliability --help`"},
    {"bench", "frame", "see `burr bench frame --help`"},
});

// The first lines of a newcomer.
constexpr const char* kProgram = R"(
examples:
  burr run                                        mill the built-in temporal bone in a window
  burr info ct_folder/                            what the scan contains, and the bone burr would make
  burr mill ct_folder/ --motion pocket --burr-mm 5 --record s.mcap --picture after.png --json
  burr replay s.mcap --check                      simulate it again and compare every tick
  burr export s.mcap --part bone --out bone.stl   a mesh to print
  burr phantom temporal-bone --voxel-mm 0.25 --out bone.seg.nrrd
)";

std::string footer_of(const std::string& command) {
  const auto line = [](const Example& example) {
    return fmt::format("burr {}{}{}", example.command, example.rest.empty() ? "" : " ",
                       example.rest);
  };
  std::size_t wide = 0;
  for (const Example& example : kExamples)
    if (example.command == command) wide = std::max(wide, line(example).size());
  if (wide == 0) return {};
  std::string text = "\nexamples:\n";
  for (const Example& example : kExamples)
    if (example.command == command)
      text += fmt::format("  {:<{}}   {}\n", line(example), wide, example.help);
  return text;
}

void add_below(CLI::App& app, const std::string& name) {
  for (CLI::App* command : app.get_subcommands({})) {
    const std::string path = name.empty() ? command->get_name() : name + " " + command->get_name();
    command->footer(footer_of(path));
    add_below(*command, path);
  }
}

}  // namespace

void add_examples(CLI::App& program) {
  program.footer(kProgram);
  add_below(program, "");
}

}  // namespace burr::app
