#include "burr/device/crtk/reach.h"

#include <arpa/inet.h>
#include <fmt/core.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace burr::device::crtk {
namespace {

// Ports of a domain (RTPS 2.2, 9.6.1): 7400 and 250 for each domain before it.
constexpr int kFirstPort = 7400, kPortsEach = 250;

// Participants find each other by asking every port of this computer that one may have.
constexpr const char* kThisComputer =
    "<Domain><General><Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>"
    "<AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
    "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain>";

std::string_view from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

// The port of a UDP socket of this process that hears on every address; 0: it is no such socket.
int open_port(int handle) {
  sockaddr_in at{};
  socklen_t size = sizeof at;
  int kind = 0;
  socklen_t kind_size = sizeof kind;
  if (::getsockopt(handle, SOL_SOCKET, SO_TYPE, &kind, &kind_size) != 0 || kind != SOCK_DGRAM ||
      ::getsockname(handle, reinterpret_cast<sockaddr*>(&at), &size) != 0 ||
      at.sin_family != AF_INET || at.sin_addr.s_addr != htonl(INADDR_ANY))
    return 0;
  return ntohs(at.sin_port);
}

// Only what comes from 127.0.0.0/8 reaches this socket.
bool keep_to_loopback(int handle) {
  constexpr std::uint32_t kSource = static_cast<std::uint32_t>(SKF_NET_OFF) + 12;  // of IPv4
  constexpr std::uint32_t kNet = 0xFF000000, kLoopback = 0x7F000000, kWhole = 0xFFFFFFFF;
  std::array<sock_filter, 5> code = {{{BPF_LD | BPF_W | BPF_ABS, 0, 0, kSource},
                                      {BPF_ALU | BPF_AND | BPF_K, 0, 0, kNet},
                                      {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, kLoopback},
                                      {BPF_RET | BPF_K, 0, 0, kWhole},
                                      {BPF_RET | BPF_K, 0, 0, 0}}};
  const sock_fprog program{static_cast<unsigned short>(code.size()), code.data()};
  return ::setsockopt(handle, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) == 0;
}

std::mutex door;
std::map<int, std::weak_ptr<Domain>>& joined() {
  static std::map<int, std::weak_ptr<Domain>> all;
  return all;
}

}  // namespace

Reach reach_asked(bool network) {
  const std::string_view range = from_environment("ROS_AUTOMATIC_DISCOVERY_RANGE");
  const bool asked = network || range == "SUBNET" || range == "SYSTEM_DEFAULT" ||
                     from_environment("ROS_LOCALHOST_ONLY") == "0" ||
                     !from_environment("CYCLONEDDS_URI").empty();
  return asked ? Reach::network : Reach::this_computer;
}

Result<std::shared_ptr<Domain>> Domain::join(int number, Reach reach) {
  const std::lock_guard lock(door);
  std::weak_ptr<Domain>& known = joined()[number];
  if (auto there = known.lock()) {
    if (there->reach_ == reach) return there;
    return error(
        Trouble::usage,
        fmt::format("DDS domain {} is open in this program for {}; use another "
                    "ROS_DOMAIN_ID",
                    number,
                    there->reach_ == Reach::network ? "the network too" : "this computer alone"));
  }
  dds_entity_t entity = 0;
  if (reach == Reach::this_computer) {
    entity = dds_create_domain(static_cast<dds_domainid_t>(number), kThisComputer);
    if (entity < 0)
      return error(Trouble::io, fmt::format("DDS cannot be opened on domain {} ({})", number,
                                            dds_strretcode(entity)));
  }
  std::shared_ptr<Domain> made(new Domain(number, reach, entity));
  known = made;
  return made;
}

Domain::~Domain() {
  if (entity_ > 0) dds_delete(entity_);
}

Status Domain::keep_others_out() const {
  if (reach_ == Reach::network) return fine();
  const int first = kFirstPort + number_ * kPortsEach;
  std::error_code trouble;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", trouble)) {
    const std::string name = entry.path().filename().string();
    int handle = -1;
    std::from_chars(name.data(), name.data() + name.size(), handle);
    const int port = open_port(handle);
    if (port < first || port >= first + kPortsEach) continue;
    if (!keep_to_loopback(handle))
      return error(Trouble::io,
                   fmt::format("DDS cannot be kept to this computer ({}); if its network may reach "
                               "it, set ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET",
                               std::strerror(errno)));
  }
  if (trouble)
    return error(Trouble::io, fmt::format("DDS cannot be kept to this computer: /proc/self/fd: {}",
                                          trouble.message()));
  return fine();
}

}  // namespace burr::device::crtk
