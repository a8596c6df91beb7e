#include "burr/device/crtk/bus.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

namespace burr::device::crtk {
namespace {

constexpr int kMostDomains = 232;  // the highest domain with valid ports (RTPS 2.2, 9.6.1)
constexpr std::string_view kPrefix = "rt";
constexpr int kHistory = 10;  // as is ROS' default

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

Qos qos(Keep keep) {
  Qos one(dds_create_qos());
  dds_qset_history(one.get(), DDS_HISTORY_KEEP_LAST, keep == Keep::all ? kHistory : 1);
  dds_qset_durability(
      one.get(), keep == Keep::last ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  return one;
}

dds_entity_t make_topic(dds_entity_t participant, const dds_topic_descriptor_t& type,
                        std::string_view topic) {
  const std::string name = std::string(kPrefix) + std::string(topic);
  return dds_create_topic(participant, &type, name.c_str(), nullptr, nullptr);
}

std::string mark_of(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  if (qos == nullptr || !dds_qget_userdata(qos, &data, &size) || data == nullptr) return {};
  std::string mark(static_cast<const char*>(data), size);
  dds_free(data);
  return mark;
}

}  // namespace

template <>
const dds_topic_descriptor_t& described<Bool>() {
  return std_msgs_msg_dds__Bool__desc;
}
template <>
const dds_topic_descriptor_t& described<PoseStamped>() {
  return geometry_msgs_msg_dds__PoseStamped__desc;
}
template <>
const dds_topic_descriptor_t& described<TwistStamped>() {
  return geometry_msgs_msg_dds__TwistStamped__desc;
}
template <>
const dds_topic_descriptor_t& described<WrenchStamped>() {
  return geometry_msgs_msg_dds__WrenchStamped__desc;
}
template <>
const dds_topic_descriptor_t& described<JointState>() {
  return sensor_msgs_msg_dds__JointState__desc;
}
template <>
const dds_topic_descriptor_t& described<Joy>() {
  return sensor_msgs_msg_dds__Joy__desc;
}
template <>
const dds_topic_descriptor_t& described<OperatingState>() {
  return crtk_msgs_msg_dds__OperatingState__desc;
}
template <>
const dds_topic_descriptor_t& described<StringStamped>() {
  return crtk_msgs_msg_dds__StringStamped__desc;
}

Bus::Bus(std::shared_ptr<Domain> share, dds_entity_t participant, int domain)
    : share_(std::move(share)), participant_(participant), domain_(domain) {}

Bus::~Bus() { dds_delete(participant_); }

Result<std::unique_ptr<Bus>> Bus::open(int domain, bool network) {
  const char* given = std::getenv("ROS_DOMAIN_ID");
  if (domain < 0 && given != nullptr && *given != '\0') {
    const std::string_view text(given);
    const auto [end, bad] = std::from_chars(text.data(), text.data() + text.size(), domain);
    if (bad != std::errc() || end != text.data() + text.size() || domain < 0 ||
        domain > kMostDomains)
      return error(Trouble::usage, fmt::format("ROS_DOMAIN_ID is \"{}\"; give a number, 0 to {}",
                                               text, kMostDomains));
  }
  domain = std::max(domain, 0);
  auto share = Domain::join(domain, reach_asked(network));
  if (!share) return share.error();
  const dds_entity_t participant =
      dds_create_participant(static_cast<dds_domainid_t>(domain), nullptr, nullptr);
  if (participant < 0)
    return error(Trouble::io, fmt::format("DDS cannot be opened on domain {} ({}); check that a "
                                          "network interface is up, and check CYCLONEDDS_URI",
                                          domain, dds_strretcode(participant)));
  std::unique_ptr<Bus> bus(new Bus(std::move(*share), participant, domain));
  if (const Status kept = bus->share_->keep_others_out(); !kept) return kept.error();
  return bus;
}

void Bus::update_writers() {
  // made only when needed: samples that are not read stay in memory
  if (publications_ <= 0)
    publications_ =
        dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  dds_guid_t own{};
  static_cast<void>(dds_get_guid(participant_, &own));
  void* sample = nullptr;
  dds_sample_info_t info{};
  while (dds_take(publications_, &sample, &info, 1, 1) > 0) {
    const auto& point = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
    const std::string key(reinterpret_cast<const char*>(&point.key), sizeof point.key);
    std::erase_if(writers_, [&key](const WriterInfo& one) { return one.key == key; });
    if (info.instance_state == DDS_IST_ALIVE && info.valid_data) {
      const std::string_view name = point.topic_name;
      if (name.starts_with("rt/"))
        writers_.push_back(
            {key,
             {std::string(name.substr(kPrefix.size())), std::string(point.type_name)},
             std::memcmp(&point.participant_key, &own, sizeof own) == 0,
             mark_of(point.qos) == kGuardian});
    }
    dds_return_loan(publications_, &sample, 1);
    sample = nullptr;
  }
}

std::vector<Topic> Bus::written() {
  update_writers();
  std::vector<Topic> all;
  for (const WriterInfo& one : writers_) all.push_back(one.topic);
  std::sort(all.begin(), all.end(), [](const Topic& a, const Topic& b) { return a.name < b.name; });
  return all;
}

int Bus::others_writing(std::string_view topic, bool guardians) {
  update_writers();
  return static_cast<int>(
      std::count_if(writers_.begin(), writers_.end(), [&](const WriterInfo& one) {
        return one.topic.name == topic && !one.ours && (guardians || !one.guardian);
      }));
}

namespace detail {

dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                         std::string_view topic, Keep keep) {
  const Qos request = qos(keep);
  // samples from before can only be had from a reliable writer
  dds_qset_reliability(request.get(),
                       keep == Keep::last ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       0);
  return dds_create_reader(participant, make_topic(participant, type, topic), request.get(),
                           nullptr);
}

dds_entity_t make_writer(dds_entity_t participant, const dds_topic_descriptor_t& type,
                         std::string_view topic, Keep keep, std::string_view mark) {
  const Qos request = qos(keep);
  if (!mark.empty()) dds_qset_userdata(request.get(), mark.data(), mark.size());
  dds_qset_reliability(request.get(), DDS_RELIABILITY_RELIABLE, 0);  // does not wait for slow
                                                                     // readers
  return dds_create_writer(participant, make_topic(participant, type, topic), request.get(),
                           nullptr);
}

bool take(dds_entity_t reader, void* sample) {
  dds_sample_info_t info{};
  while (dds_take(reader, &sample, &info, 1, 1) > 0)
    if (info.valid_data) return true;
  return false;
}

}  // namespace detail

Stamp now_stamp() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return {static_cast<std::int32_t>(now.tv_sec), static_cast<std::uint32_t>(now.tv_nsec)};
}

math::Pose pose_of(const geometry_msgs_msg_dds__Pose_& pose) {
  math::Pose out;
  out.p = {pose.position_.x_, pose.position_.y_, pose.position_.z_};
  out.q = math::Quat(pose.orientation_.w_, pose.orientation_.x_, pose.orientation_.y_,
                     pose.orientation_.z_);
  return out;
}

geometry_msgs_msg_dds__Pose_ message_of(const math::Pose& pose) {
  return {{pose.p.x(), pose.p.y(), pose.p.z()}, {pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()}};
}

geometry_msgs_msg_dds__Vector3_ message_of(const math::Vec3& v) { return {v.x(), v.y(), v.z()}; }
math::Vec3 vector_of(const geometry_msgs_msg_dds__Vector3_& v) { return {v.x_, v.y_, v.z_}; }

std::string arm_name(std::string_view given) {
  while (given.ends_with('/')) given.remove_suffix(1);
  while (given.starts_with('/')) given.remove_prefix(1);
  bool begins = true;  // start of a part of the name; a part is never empty and never begins with a
                       // digit
  for (const char c : given) {
    const auto letter = static_cast<unsigned char>(c);
    if (c == '/'
            ? begins
            : !(std::isalpha(letter) != 0 || c == '_' || (!begins && std::isdigit(letter) != 0)))
      return {};
    begins = c == '/';
  }
  return given.empty() ? std::string() : "/" + std::string(given);
}

}  // namespace burr::device::crtk
