// device/crtk/bus.h - the bus of CRTK arms: DDS with the topic names of ROS 2; ROS itself is not
// needed. For use of this room only.
//
//     auto bus = Bus::open(-1);                         // domain: ROS_DOMAIN_ID
//     Reader<PoseStamped> place((*bus)->participant(), "/MTMR/measured_cp", Keep::newest);
//     if (const PoseStamped* newest = place.take()) ...
//
// The topic /x of ROS is rt/x here, its type p::msg::dds_::T_ (crtk_messages.idl). Writers are
// reliable, keep one sample and never wait; readers accept reliable and best-effort writers.
// Thread: each Reader and each Writer on one thread at a time. Errors: open() says why a bus cannot
// be opened. After that there are no errors: a reader that could not be made reads nothing, a
// writer that could not be made writes nothing.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <crtk_messages.h>
#include "burr/base/result.h"
#include "burr/device/crtk/reach.h"
#include "burr/math/pose.h"

namespace burr::device::crtk {

using Stamp = builtin_interfaces_msg_dds__Time_;
using Bool = std_msgs_msg_dds__Bool_;
using PoseStamped = geometry_msgs_msg_dds__PoseStamped_;
using TwistStamped = geometry_msgs_msg_dds__TwistStamped_;
using WrenchStamped = geometry_msgs_msg_dds__WrenchStamped_;
using JointState = sensor_msgs_msg_dds__JointState_;
using Joy = sensor_msgs_msg_dds__Joy_;
using OperatingState = crtk_msgs_msg_dds__OperatingState_;
using StringStamped = crtk_msgs_msg_dds__StringStamped_;

template <class T>
[[nodiscard]] const dds_topic_descriptor_t& described();

// A topic that somebody writes or reads, as DDS discovery reports it.
struct Topic {
  std::string name;  // as in ROS: /MTMR/measured_cp
  std::string type;  // geometry_msgs::msg::dds_::PoseStamped_
};

class Bus {
 public:
  // domain: 0..232; below 0: ROS_DOMAIN_ID, else 0. network: other computers may reach it, as they may where the
  // environment asks for it (reach.h). Error: why the bus cannot be opened.
  [[nodiscard]] static Result<std::unique_ptr<Bus>> open(int domain, bool network = false);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  [[nodiscard]] dds_entity_t participant() const { return participant_; }
  [[nodiscard]] int domain() const { return domain_; }
  [[nodiscard]] Reach reach() const { return share_->reach(); }
  // The ROS topics that somebody writes, as far as discovered by now; sorted.
  [[nodiscard]] std::vector<Topic> written();
  // Number of other writers of a topic, as far as discovered by now. guardians: count burr's own
  // guardian processes too, which write nothing but "no force" (device/guardian.h).
  [[nodiscard]] int others_writing(std::string_view topic, bool guardians);

 private:
  Bus(std::shared_ptr<Domain> share, dds_entity_t participant, int domain);

  struct WriterInfo {
    std::string key;  // of the writer
    Topic topic;
    bool ours = false, guardian = false;
  };
  void update_writers();

  std::shared_ptr<Domain> share_;
  dds_entity_t participant_, publications_ = 0;
  int domain_;
  std::vector<WriterInfo> writers_;
};

// Mark of a guardian's writer, by which others recognize it.
inline constexpr std::string_view kGuardian = "burr-guard";

enum class Keep {
  newest,  // keeps one sample: for measured values
  all,     // keeps ten: for events
  last,    // keeps ten, and gets the last one written before it joined
};

namespace detail {
[[nodiscard]] dds_entity_t make_reader(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                       std::string_view topic, Keep keep);
[[nodiscard]] dds_entity_t make_writer(dds_entity_t participant, const dds_topic_descriptor_t& type,
                                       std::string_view topic, Keep keep, std::string_view mark);
[[nodiscard]] bool take(dds_entity_t reader, void* sample);
}  // namespace detail

template <class T>
class Reader {
 public:
  Reader(dds_entity_t participant, std::string_view topic, Keep keep)
      : entity_(detail::make_reader(participant, described<T>(), topic, keep)) {}
  ~Reader() {
    dds_delete(entity_);
    dds_sample_free(&sample_, &described<T>(), DDS_FREE_CONTENTS);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  // The next sample, oldest first; valid until the next take(). nullptr: there is none.
  [[nodiscard]] const T* take() { return detail::take(entity_, &sample_) ? &sample_ : nullptr; }
  [[nodiscard]] dds_entity_t entity() const { return entity_; }

 private:
  dds_entity_t entity_;
  T sample_{};
};

template <class T>
class Writer {
 public:
  // mark: a text by which others recognize this writer
  Writer(dds_entity_t participant, std::string_view topic, Keep keep = Keep::newest,
         std::string_view mark = {})
      : entity_(detail::make_writer(participant, described<T>(), topic, keep, mark)) {}
  ~Writer() { dds_delete(entity_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  // False: the sample was not written.
  bool write(const T& sample) { return dds_write(entity_, &sample) == DDS_RETCODE_OK; }
  // Number of readers.
  [[nodiscard]] int readers() const { return dds_get_matched_subscriptions(entity_, nullptr, 0); }
  // Waits until every reader has the samples, for at most `longest` [ns].
  void flush(std::int64_t longest) { dds_wait_for_acks(entity_, longest); }

 private:
  dds_entity_t entity_;
};

// The time as ROS counts it: since 1970.
[[nodiscard]] Stamp now_stamp();
[[nodiscard]] inline bool is_zero(const Stamp& stamp) {
  return stamp.sec_ == 0 && stamp.nanosec_ == 0;
}
// Lends our text to a sample. The sample is only written to the bus, so the text is not changed.
[[nodiscard]] inline char* as_sample_text(const char* text) { return const_cast<char*>(text); }

[[nodiscard]] math::Pose pose_of(const geometry_msgs_msg_dds__Pose_& pose);
[[nodiscard]] geometry_msgs_msg_dds__Pose_ message_of(const math::Pose& pose);
[[nodiscard]] geometry_msgs_msg_dds__Vector3_ message_of(const math::Vec3& v);
[[nodiscard]] math::Vec3 vector_of(const geometry_msgs_msg_dds__Vector3_& v);

// A ROS namespace as a user may write it, "MTMR" or "/MTMR/", as "/MTMR". Empty: not a valid one.
[[nodiscard]] std::string arm_name(std::string_view given);

}  // namespace burr::device::crtk
