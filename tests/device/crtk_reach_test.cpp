// How far the bus reaches: what comes from elsewhere than this computer's loopback is dropped by the kernel,
// unless somebody asked for the network. The kernel's own count of dropped datagrams (/proc/net/udp) is the witness.
#include "burr/device/crtk/reach.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "burr/device/crtk/arm.h"
#include "burr/device/crtk/bus.h"
#include "device/fake/fake_crtk.h"

namespace burr::device::crtk {
namespace {

// Sockets of the domain that hear on every address: port and dropped datagrams.
std::map<int, long> heard_at(int domain) {
  std::map<int, long> all;
  std::ifstream in("/proc/net/udp");
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string word, local, last;
    words >> word >> local;
    while (words >> word) last = word;
    if (!local.starts_with("00000000:")) continue;
    const int port = static_cast<int>(std::strtol(local.substr(9).c_str(), nullptr, 16));
    if (port >= 7400 + 250 * domain && port < 7650 + 250 * domain) all[port] = std::stol(last);
  }
  return all;
}

// An address of this computer that is not its loopback; 0: none.
in_addr_t own_address() {
  in_addr_t found = 0;
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return 0;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next)
    if (one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET &&
        (one->ifa_flags & IFF_LOOPBACK) == 0 && (one->ifa_flags & IFF_UP) != 0)
      found = reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr.s_addr;
  ::freeifaddrs(all);
  return found;
}

// Datagrams of 20 bytes that are no RTPS, from this address to the same at each port; how many were dropped.
long dropped(int domain, in_addr_t address) {
  const auto before = heard_at(domain);
  for (const auto& [port, drops] : before) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in from{}, to{};
    from.sin_family = to.sin_family = AF_INET;
    from.sin_addr.s_addr = to.sin_addr.s_addr = address;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&from), sizeof from), 0);
    const char junk[20] = {};
    for (int n = 0; n < 3; ++n)
      EXPECT_EQ(
          ::sendto(socket, junk, sizeof junk, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
          20);
    ::close(socket);
  }
  const auto after = heard_at(domain);
  long sum = 0;
  for (const auto& [port, drops] : after)
    if (const auto at = before.find(port); at != before.end()) sum += drops - at->second;
  return sum;
}

class Reaching : public testing::Test {
 protected:
  Reaching() {
    for (const char* name :
         {"ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY", "CYCLONEDDS_URI"})
      ::unsetenv(name);
  }
  ~Reaching() override { ::unsetenv("ROS_AUTOMATIC_DISCOVERY_RANGE"); }
  const int domain_ = test::quiet_domain();
};

TEST_F(Reaching, ThisComputerAloneUnlessAsked) {
  auto arm = Arm::open({.name = "/burr", .domain = domain_});
  ASSERT_TRUE(arm.ok()) << arm.error().text;
  EXPECT_FALSE((*arm)->on_network());
  const auto sockets = heard_at(domain_);
  ASSERT_GE(sockets.size(), 2U);
  EXPECT_EQ(dropped(domain_, htonl(INADDR_LOOPBACK)), 0);
  const in_addr_t own = own_address();
  if (own == 0) GTEST_SKIP() << "this computer has no address but its loopback";
  EXPECT_EQ(dropped(domain_, own), 3 * static_cast<long>(sockets.size()));
}

TEST_F(Reaching, TheNetworkWhereASettingOrTheEnvironmentAsks) {
  const in_addr_t own = own_address();
  if (own == 0) GTEST_SKIP() << "this computer has no address but its loopback";
  {
    auto arm = Arm::open({.name = "/burr", .domain = domain_, .network = true});
    ASSERT_TRUE(arm.ok()) << arm.error().text;
    EXPECT_TRUE((*arm)->on_network());
    EXPECT_EQ(dropped(domain_, own), 0);
    // one program, one domain, one reach
    const auto second = Bus::open(domain_);
    ASSERT_FALSE(second.ok());
    EXPECT_NE(second.error().text.find("is open in this program for the network too"),
              std::string::npos)
        << second.error().text;
  }
  ::setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET", 1);
  const auto bus = Bus::open(domain_);
  ASSERT_TRUE(bus.ok()) << bus.error().text;
  EXPECT_EQ((*bus)->reach(), Reach::network);
  ::setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST", 1);
  EXPECT_EQ(reach_asked(false), Reach::this_computer);
}

}  // namespace
}  // namespace burr::device::crtk
