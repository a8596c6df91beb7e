#include "burr/device/polhem/polhem.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "burr/rt/clock.h"

namespace burr::device::polhem {
namespace {

namespace fs = std::filesystem;
using math::Quat;
using math::Vec3;

constexpr int kOneReadingMs = 2;               // wait of read()
constexpr int kWakesMs = 1500, kWakeMs = 50;   // for an arm that starts when its port is opened
constexpr std::int64_t kAgainNs = 20'000'000;  // without an answer for so long, a line was lost in
                                               // one direction
// After a pause this long between two beats, the guardian has written to the arm, or was about to.
constexpr std::int64_t kGuardedNs = (Guardian::kMissedMs - 10) * std::int64_t{1'000'000};
constexpr std::int64_t kQuietNs = 5'000'000;        // silence after which no more answers are
                                                    // expected
constexpr std::int64_t kCatchUpNs = 1'000'000'000;  // time in which the line must become silent
constexpr int kMostNonsense = 50;                   // invalid lines in a row
constexpr double kPeak = 5, kContinuous = 1.5;      // [N]; the former from the maker's polhem_v3
constexpr double kStiffness = 2000, kDamping = 1;   // [N/m], [N s/m], likewise
constexpr double kRadius = 150e-3;                  // [m], likewise
constexpr double kSlowest = 1e-3;                   // time constant of the velocity filter [s]

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::string word;
  in >> word;
  return word;
}

// From the arm's frame to ours, and back.
Vec3 ours(const Vec3& v) BURR_RT { return {v.y(), v.z(), v.x()}; }
Vec3 theirs(const Vec3& v) BURR_RT { return {v.z(), v.x(), v.y()}; }

Quat about(const Vec3& axis, double angle) BURR_RT { return Quat(Eigen::AngleAxisd(angle, axis)); }

// The orientation of the tool: the wrist's chain (uhaptikfabriken.h, getRot(), without the stylus'
// own rotation); its x becomes the tool's z.
Quat turn_of(const State& state) BURR_RT {
  const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const Quat wrist = about(z, state.tA) * about(y, -state.lambda) * about(x, state.tD) *
                     about(y, state.tE) * about(y, M_PI / 2);
  // from x to the user, y right, z up to x right, y up, z to the user: a third of a turn
  const Quat frame(0.5, -0.5, -0.5, -0.5);
  return frame * wrist;
}

}  // namespace

std::vector<Port> ports_of_arms(const std::string& system) {
  std::vector<Port> ports;
  std::error_code nobody_asks;
  for (const auto& entry :
       fs::directory_iterator(fs::path(system) / "sys/class/tty", nobody_asks)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("ttyACM")) continue;
    const fs::path device = fs::canonical(entry.path() / "device", nobody_asks).parent_path();
    if (text_of(device / "idVendor") == "16c0" && text_of(device / "idProduct").starts_with("04"))
      ports.push_back({(fs::path(system) / "dev" / name).string(), text_of(device / "serial")});
  }
  std::sort(ports.begin(), ports.end(),
            [](const Port& a, const Port& b) { return a.path < b.path; });
  return ports;
}

Polhem::Polhem(PolhemSettings settings) : settings_(std::move(settings)) {}
Polhem::~Polhem() { disconnect(); }

Result<DeviceSpec> Polhem::connect() {
  disconnect();
  const std::vector<Port> known = ports_of_arms(settings_.system);
  Port port{settings_.port, ""};
  if (port.path.empty() && known.empty())
    return error(Trouble::io,
                 "no Polhem is plugged in (no /dev/ttyACM of USB 16c0:04xx); plug it in and switch "
                 "it on, or name its port: polhem:/dev/ttyACM0");
  for (const Port& one : known)
    if (port.path.empty() || one.path == port.path) {
      port = one;
      break;
    }
  const auto fail = [&](const std::string& why) {
    guardian_.reset();  // it holds the port open and would block the next attempt
    if (port_ >= 0) ::close(port_);
    port_ = -1;
    return error(Trouble::io, why);
  };
  port_ = ::open(port.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (port_ < 0 && errno == EACCES)
    return fail(
        fmt::format("{}: your user may not open it; run sudo usermod -aG dialout $USER, and "
                    "log in again",
                    port.path));
  if (port_ < 0)
    return fail(
        fmt::format("{} cannot be opened ({}); `workshop::names_there` lists what is connected",
                    port.path, std::strerror(errno)));
  termios raw{};
  if (::tcgetattr(port_, &raw) != 0)
    return fail(fmt::format("{} is not a serial port; give the port of the arm", port.path));
  if (::flock(port_, LOCK_EX | LOCK_NB) != 0 || ::ioctl(port_, TIOCEXCL) != 0)
    return fail(fmt::format("{} is in use by another program; close that program", port.path));
  ::cfmakeraw(&raw);
  raw.c_cflag |= CLOCAL | CREAD;
  ::cfsetspeed(&raw, B115200);
  if (::tcsetattr(port_, TCSANOW, &raw) != 0)
    return fail(fmt::format("{} cannot be set up ({}); unplug it and plug it in again", port.path,
                            std::strerror(errno)));
  ::tcflush(port_, TCIOFLUSH);
  lines_.clear();
  unsent_bytes_ = 0;
  invalid_lines_ = 0;
  answers_late_ = false;
  name_ = "the Polhem at " + port.path;

  // Ask without force until it answers; boards restart when their port is opened.
  Received heard = Received::nothing;
  for (int waited = 0; heard == Received::nothing && waited < kWakesMs; waited += kWakeMs) {
    if (waited > 0) note_late_answer(rt::monotonic_ns());
    heard = send(Vec3::Zero()) ? receive(kWakeMs) : Received::gone;
  }
  if (heard != Received::state)
    return fail(invalid_lines_ > 0
                    ? fmt::format("{} does not answer as a Polhem does; give another port, or "
                                  "install the maker's firmware of 2021 or later on the arm",
                                  port.path)
                    : fmt::format("{} does not answer; switch the arm on, unplug it and plug it in "
                                  "again",
                                  port.path));
  const Line none = force_line(Vec3::Zero());
  auto guardian = Guardian::start({"line", std::string(none.data(), none.size())}, port_);
  if (!guardian) return fail(guardian.error().text);
  guardian_ = std::move(*guardian);
  if (!send(Vec3::Zero())) return fail(port.path + " was unplugged; plug it in again");
  answered_ns_ = rt::monotonic_ns();
  silence_.ended(answered_ns_);
  last_beat_ns_ = answered_ns_;
  last_place_ = state_.place;
  velocity_.setZero();
  trouble_ = nullptr;

  DeviceSpec spec;
  spec.name = "Polhem";
  spec.serial = port.serial.empty() ? port.path : port.serial;
  spec.simulated = false;
  spec.sensed = 5;
  spec.actuated = 3;
  spec.peak_force = kPeak;
  spec.continuous_force = kContinuous;
  spec.thermal_budget = 5 * kPeak * kPeak;
  spec.max_stiffness = kStiffness;
  spec.max_damping = kDamping;
  spec.workspace_radius = kRadius;
  spec.native_rate = 1000;
  return spec;
}

void Polhem::note(const char* words) BURR_RT {
  if (trouble_ != words) ++why_revision_;
  trouble_ = words;
}

Polhem::Received Polhem::receive(int longest_ms) BURR_RT {
  const std::int64_t until = rt::monotonic_ns() + std::int64_t{1'000'000} * longest_ms;
  for (;;) {
    const ssize_t got = ::read(port_, lines_.room(), lines_.left());
    if (got > 0) {
      const int before = invalid_lines_;
      if (!lines_.take(static_cast<std::size_t>(got), state_, invalid_lines_)) {
        if (invalid_lines_ == before) continue;  // a part of a line
        awaits_answer_ = false;                  // an answer, but not a usable one
        return Received::nothing;
      }
      invalid_lines_ = 0;
      awaits_answer_ = false;
      return Received::state;
    }
    // a terminal whose other end is closed reads as end of file, or as an error
    if (got == 0 || (errno != EAGAIN && errno != EINTR)) return Received::gone;
    const std::int64_t left = until - rt::monotonic_ns();
    if (left <= 0) return Received::nothing;
    pollfd waits{port_, POLLIN, 0};
    const timespec longest{left / 1'000'000'000, left % 1'000'000'000};
    if (::ppoll(&waits, 1, &longest, nullptr) == 0) return Received::nothing;
    if ((waits.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0 && (waits.revents & POLLIN) == 0)
      return Received::gone;
  }
}

bool Polhem::send(const Vec3& force) BURR_RT {
  if (unsent_bytes_ == 0) {
    out_ = force_line(force);
    unsent_bytes_ = kLine;
  }
  // finish a line that was sent in part: the arm would read two lines as one
  while (unsent_bytes_ > 0) {
    const ssize_t put = ::write(port_, out_.data() + (kLine - unsent_bytes_), unsent_bytes_);
    if (put > 0)
      unsent_bytes_ -= static_cast<std::size_t>(put);
    else if (errno == EAGAIN || errno == EINTR)
      return true;
    else
      return false;
  }
  awaits_answer_ = true;
  sent_ns_ = rt::monotonic_ns();
  return true;
}

// More lines were sent than answered, by burr or by the guardian. If burr sent a new line for each
// of those answers, every force would from then on reach the arm so many lines late.
void Polhem::note_late_answer(std::int64_t now) BURR_RT {
  if (answers_late_) return;
  answers_late_ = true;
  zero_was_sent_ = false;
  late_since_ns_ = now;
}

Wire::Read Polhem::read(HandState& hand) BURR_RT {
  hand.valid = false;
  const std::int64_t begun = rt::monotonic_ns();
  if (begun - last_beat_ns_ > kGuardedNs) note_late_answer(begun);
  last_beat_ns_ = begun;
  guardian_->beat();
  const Received heard = receive(kOneReadingMs);
  const std::int64_t now = rt::monotonic_ns();
  // silence counts only after an answer: an arm that hangs has not sent yet what it owes
  if (heard == Received::nothing && !awaits_answer_ &&
      now - std::max(answered_ns_, late_since_ns_) > kQuietNs)
    answers_late_ = false;
  if (answers_late_ && now - late_since_ns_ > kCatchUpNs) {
    note(
        "sends more answers than burr asked for, or sends them too late; unplug it and plug it in "
        "again.");
    return Read::lost;
  }
  if (heard == Received::gone) {
    note("was unplugged; plug it in again.");
    return Read::lost;
  }
  if (invalid_lines_ > kMostNonsense) {
    note("sends data that burr cannot read; unplug it and plug it in again.");
    return Read::lost;
  }
  if (heard == Received::nothing) {
    if (!silence_.lasts(now)) return Read::nothing;
    note("has gone silent; check that it is switched on.");
    return Read::lost;
  }
  const double dt = 1e-9 * static_cast<double>(now - answered_ns_);
  answered_ns_ = now;
  silence_.ended(now);
  velocity_ +=
      dt / (dt + kSlowest) * ((state_.place - last_place_) / std::max(dt, 1e-5) - velocity_);
  last_place_ = state_.place;
  note(state_.info != 0 ? "reports a state that burr does not know; see its maker's program."
                        : nullptr);
  hand.world_from_tool = {ours(state_.place), turn_of(state_)};
  hand.velocity = ours(velocity_);
  hand.buttons = 0;
  hand.valid = true;
  return Read::hand;
}

bool Polhem::write(const Vec3& force) BURR_RT {
  // the answer is still to come; if a line was lost on the way, send another
  const std::int64_t now = rt::monotonic_ns();
  if (awaits_answer_ && now - sent_ns_ < kAgainNs) return true;
  if (awaits_answer_) note_late_answer(now);
  const bool whole = unsent_bytes_ == 0;
  if (answers_late_ && zero_was_sent_ && !awaits_answer_ && whole) return true;
  if (!send(answers_late_ ? Vec3::Zero() : theirs(bounded(force, kPeak)))) {
    note("was unplugged; plug it in again.");
    return false;
  }
  zero_was_sent_ = answers_late_ && whole;
  return true;
}

void Polhem::disconnect() {
  if (port_ < 0) return;
  static_cast<void>(send(Vec3::Zero()));  // the rest of a line that was sent in part, or "no force"
  static_cast<void>(send(Vec3::Zero()));
  guardian_.reset();
  ::close(port_);
  port_ = -1;
}

std::string Polhem::why() const {
  return trouble_ != nullptr ? name_ + " " + trouble_ : std::string();
}

}  // namespace burr::device::polhem
