#include "burr/io/sandbox/fence_letter.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "burr/base/version.h"
#include "burr/io/read/samples.h"

namespace burr::io {
namespace {

constexpr std::size_t kLongestText = std::size_t{1} << 16;
constexpr std::size_t kMostLabels = 4096, kMostNotices = 4096, kMostSeries = 4096,
                      kMostQuestions = 16, kMostOfStudy = 64;

class Packer {
 public:
  explicit Packer(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  void put(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    raw(&value, sizeof(T));
  }
  void put(const std::string& text) {
    const std::size_t n = std::min(text.size(), kLongestText);
    put(static_cast<std::uint32_t>(n));
    raw(text.data(), n);
  }
  void put(const math::Vec3& v) {
    for (int a = 0; a < 3; ++a) put(v[a]);
  }
  [[nodiscard]] std::size_t size() const { return fits_ ? at_ : 0; }

 private:
  void raw(const void* from, std::size_t n) {
    fits_ = fits_ && n <= bytes_.size() - at_;
    if (!fits_ || n == 0) return;
    std::memcpy(bytes_.data() + at_, from, n);
    at_ += n;
  }
  std::span<std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool fits_ = true;
};

class Unpacker {
 public:
  explicit Unpacker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  T get() {
    static_assert(std::is_arithmetic_v<T>);
    T value = 0;
    if (bytes_.size() - at_ < sizeof(T)) {
      good_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }
  std::string text() {
    const std::size_t n = get<std::uint32_t>();
    if (!good_ || n > kLongestText || n > bytes_.size() - at_) {
      good_ = false;
      return {};
    }
    std::string out(reinterpret_cast<const char*>(bytes_.data() + at_), n);
    at_ += n;
    return out;
  }
  // text for the user: terminal control characters become spaces
  std::string words() {
    std::string out = text();
    for (char& c : out)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
    return out;
  }
  double number() {  // finite
    const double value = get<double>();
    if (!std::isfinite(value)) good_ = false;
    return value;
  }
  math::Vec3 vec3() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  std::size_t count(std::size_t most) {
    const std::size_t n = get<std::uint32_t>();
    if (n > most) good_ = false;
    return good_ ? n : 0;
  }
  void demand(bool true_here) { good_ = good_ && true_here; }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] bool whole() const { return good_ && at_ == bytes_.size(); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

// both sides must agree about this, structs included
std::string version() { return std::string("fence 8 of burr ") + base::version(); }

Trouble trouble_of(std::int32_t number) {
  switch (static_cast<Trouble>(number)) {
    case Trouble::usage:
    case Trouble::io:
    case Trouble::interrupted:
      return static_cast<Trouble>(number);
    default:
      return Trouble::data;
  }
}

void pack_scan(Packer& to, const Scan& scan) {
  for (int a = 0; a < 3; ++a) to.put(static_cast<std::int32_t>(scan.size[a]));
  to.put(scan.spacing_mm);
  for (int a = 0; a < 3; ++a) to.put(math::Vec3(scan.axes.col(a)));
  to.put(scan.origin_mm);
  to.put(static_cast<std::uint8_t>(scan.hounsfield));
  to.put(static_cast<std::uint8_t>(scan.outside.has_value()));
  to.put(scan.outside.value_or(0.0F));
  to.put(static_cast<std::uint8_t>(scan.k_reversed));
  to.put(scan.format);
  to.put(scan.modality);
  to.put(static_cast<std::uint32_t>(scan.notices.size()));
  for (const std::string& notice : scan.notices) to.put(notice);
  to.put(static_cast<std::uint32_t>(scan.series.size()));
  for (const std::string& series : scan.series) to.put(series);
  to.put(static_cast<std::uint32_t>(scan.series_dates.size()));
  for (const std::string& date : scan.series_dates) to.put(date);
  to.put(static_cast<std::int32_t>(scan.series_taken));
  to.put(static_cast<std::uint32_t>(scan.questions.size()));
  for (const Question& question : scan.questions) {
    to.put(static_cast<std::uint8_t>(question.ask));
    to.put(question.text);
  }
  to.put(static_cast<std::uint32_t>(scan.label_names.size()));
  for (const Label& label : scan.label_names) {
    to.put(static_cast<std::int32_t>(label.value));
    to.put(label.name);
    for (const float c : label.colour) to.put(c);
    to.put(label.meaning);
    to.put(label.in_file);
  }
  to.put(static_cast<std::uint8_t>(scan.study.has_value()));
  if (!scan.study) return;
  to.put(scan.study->characters);
  to.put(static_cast<std::uint32_t>(scan.study->values.size()));
  for (const auto& [tag, text] : scan.study->values) {
    to.put(tag);
    to.put(text);
  }
}

void unpack_scan(Unpacker& from, Scan& scan) {
  for (int a = 0; a < 3; ++a) {
    scan.size[a] = from.get<std::int32_t>();
    from.demand(scan.size[a] >= 1 && scan.size[a] <= 1 << 20);
  }
  scan.spacing_mm = from.vec3();
  from.demand((scan.spacing_mm.array() > 0).all());
  for (int a = 0; a < 3; ++a) scan.axes.col(a) = from.vec3();
  from.demand((scan.axes.transpose() * scan.axes - math::Mat3::Identity()).norm() < 1e-6 &&
              scan.axes.determinant() > 0);
  scan.origin_mm = from.vec3();
  scan.hounsfield = from.get<std::uint8_t>() != 0;
  const bool has_outside = from.get<std::uint8_t>() != 0;
  const float outside = from.get<float>();
  from.demand(std::isfinite(outside));
  if (has_outside) scan.outside = outside;
  scan.k_reversed = from.get<std::uint8_t>() != 0;
  scan.format = from.words();
  scan.modality = from.words();
  for (std::size_t n = from.count(kMostNotices); n > 0 && from.good(); --n)
    scan.notices.push_back(from.words());
  const std::size_t series = from.count(kMostSeries);
  for (std::size_t n = 0; n < series && from.good(); ++n) scan.series.push_back(from.words());
  for (std::size_t n = from.count(kMostSeries); n > 0 && from.good(); --n)
    scan.series_dates.push_back(from.words());
  from.demand(scan.series_dates.empty() || scan.series_dates.size() == series);
  scan.series_taken = from.get<std::int32_t>();
  from.demand(scan.series_taken >= 0 &&
              static_cast<std::size_t>(scan.series_taken) < std::max<std::size_t>(series, 1));
  for (std::size_t n = from.count(kMostQuestions); n > 0 && from.good(); --n) {
    const auto ask = static_cast<Ask>(from.get<std::uint8_t>());
    from.demand(ask >= Ask::missing && ask <= Ask::doubt);
    scan.ask(ask, from.words());
  }
  for (std::size_t n = from.count(kMostLabels); n > 0 && from.good(); --n) {
    Label label;
    label.value = from.get<std::int32_t>();
    from.demand(label.value >= 0 && label.value <= 255);
    label.name = from.words();
    for (float& c : label.colour) {
      c = from.get<float>();
      from.demand(c >= 0 && c <= 1);
    }
    label.meaning = from.words();
    label.in_file = from.get<std::int64_t>();
    scan.label_names.push_back(std::move(label));
  }
  if (from.get<std::uint8_t>() == 0) return;
  DicomStudy& study = scan.study.emplace();
  study.characters = from.text();
  for (std::size_t n = from.count(kMostOfStudy); n > 0 && from.good(); --n) {
    const auto tag = from.get<std::uint32_t>();
    study.values[tag] = from.text();
  }
}

}  // namespace

std::size_t pack(const FenceRequest& request, std::span<std::uint8_t> letter) {
  Packer to(letter);
  to.put(version());
  to.put(request.path);
  to.put(static_cast<std::uint8_t>(request.mesh));
  to.put(request.options.series);
  to.put(request.options.spacing_mm);
  to.put(static_cast<std::uint8_t>(request.options.check_values));
  to.put(static_cast<std::uint8_t>(request.options.check_scan));
  to.put(static_cast<std::uint8_t>(request.options.study));
  to.put(request.options.seconds);
  to.put(request.options.memory_mb);
  return to.size();
}

bool unpack(std::span<const std::uint8_t> bytes, FenceRequest& request) {
  Unpacker from(bytes);
  from.demand(from.text() == version());
  request.path = from.text();
  request.mesh = from.get<std::uint8_t>() != 0;
  request.options.series = from.text();
  for (int a = 0; a < 3; ++a) request.options.spacing_mm[a] = from.get<double>();
  request.options.check_values = from.get<std::uint8_t>() != 0;
  request.options.check_scan = from.get<std::uint8_t>() != 0;
  request.options.study = from.get<std::uint8_t>() != 0;
  request.options.seconds = from.get<double>();
  request.options.memory_mb = from.get<double>();
  return from.whole();
}

std::size_t pack(const FenceOutcome& outcome, std::span<std::uint8_t> letter) {
  Packer to(letter);
  to.put(static_cast<std::uint8_t>(outcome.scan.ok()));
  if (outcome.scan.ok()) {
    pack_scan(to, *outcome.scan);
    to.put(outcome.values_loan);
    to.put(outcome.values);
    to.put(outcome.labels_loan);
    to.put(outcome.labels);
  } else {
    to.put(static_cast<std::int32_t>(outcome.scan.error().trouble));
    to.put(outcome.scan.error().text);
  }
  return to.size();
}

bool unpack(std::span<const std::uint8_t> bytes, FenceOutcome& outcome) {
  Unpacker from(bytes);
  if (from.get<std::uint8_t>() == 0) {
    const Trouble trouble = trouble_of(from.get<std::int32_t>());
    outcome.scan = error(trouble, from.words());
    return from.whole();
  }
  Scan scan;
  unpack_scan(from, scan);
  outcome.values_loan = from.get<std::uint32_t>();
  outcome.values = from.get<std::uint64_t>();
  outcome.labels_loan = from.get<std::uint32_t>();
  outcome.labels = from.get<std::uint64_t>();
  if (!from.whole()) return false;
  auto count = voxel_count("", scan.size.x(), scan.size.y(), scan.size.z());
  if (!count || std::max(outcome.values, outcome.labels) != *count ||
      std::min(outcome.values, outcome.labels) != 0)
    return false;
  outcome.scan = std::move(scan);
  return true;
}

}  // namespace burr::io
