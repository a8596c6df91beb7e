#include "burr/dataset/hdf5_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "burr/record/rename_and_sync.h"

namespace burr::dataset {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));
static_assert(std::endian::native == std::endian::little, "rows go into the file as they are");

// A handle of HDF5, given back at the end.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  [[nodiscard]] hid_t get() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

// Numbers of 16 bits: a sign, 5 bits of exponent, 10 of fraction. HDF5 1.10 has no name for them.
hid_t half_type() {
  const hid_t type = H5Tcopy(H5T_IEEE_F32LE);
  H5Tset_fields(type, 15, 10, 5, 0, 10);
  H5Tset_size(type, 2);
  H5Tset_ebias(type, 15);
  return type;
}

hid_t type_of(Kind kind) {
  switch (kind) {
    case Kind::f64:
      return H5Tcopy(H5T_IEEE_F64LE);
    case Kind::f16:
      return half_type();
    case Kind::i32:
      return H5Tcopy(H5T_STD_I32LE);
    case Kind::u8:
      return H5Tcopy(H5T_STD_U8LE);
  }
  return -1;
}

hid_t text_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

std::vector<hsize_t> shape_with(hsize_t rows, std::span<const std::uint64_t> row_shape) {
  std::vector<hsize_t> shape = {rows};
  shape.insert(shape.end(), row_shape.begin(), row_shape.end());
  return shape;
}

// No time of its own: equal content is equal bytes.
hid_t plain_properties() {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(properties, 0);
  return properties;
}

}  // namespace

std::size_t bytes_of(Kind kind) {
  switch (kind) {
    case Kind::f64:
      return 8;
    case Kind::i32:
      return 4;
    case Kind::f16:
      return 2;
    case Kind::u8:
      return 1;
  }
  return 0;
}

std::uint16_t half_of(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16 & 0x8000U, size = bits & 0x7FFFFFFFU;
  if (size > 0x7F800000U) return static_cast<std::uint16_t>(sign | 0x7E00U);   // not a number
  if (size >= 0x477FF000U) return static_cast<std::uint16_t>(sign | 0x7C00U);  // too large
  std::uint32_t cut = 13, whole = size - (112U << 23);  // exponent of 8 bits to one of 5
  if (size < 0x38800000U) {                             // below the smallest normal number
    const std::uint32_t exponent = size >> 23;
    if (exponent < 102) return static_cast<std::uint16_t>(sign);
    cut = 126 - exponent;
    whole = (size & 0x7FFFFFU) | 0x800000U;
  }
  const std::uint32_t half = 1U << (cut - 1), rest = whole & ((1U << cut) - 1);
  std::uint32_t result = whole >> cut;
  if (rest > half || (rest == half && (result & 1U) != 0)) ++result;
  return static_cast<std::uint16_t>(sign | result);
}

void Column::add(const void* row) {
  ++rows_;
  const auto* const bytes = static_cast<const std::byte*>(row);
  waiting_.insert(waiting_.end(), bytes, bytes + row_bytes_);
  if (waiting_.size() >= row_bytes_ * rows_at_once_) flush();
}

void Column::flush() {
  if (waiting_.empty() || !file_->trouble_.empty()) return;
  const hsize_t some = waiting_.size() / row_bytes_;
  const std::vector<hsize_t> size = shape_with(rows_, row_shape_),
                             part = shape_with(some, row_shape_);
  std::vector<hsize_t> first(size.size(), 0);
  first[0] = rows_ - some;
  const int axes = static_cast<int>(size.size());
  bool well = H5Dset_extent(dataset_, size.data()) >= 0;
  const Handle all(H5Dget_space(dataset_), H5Sclose);
  const Handle mine(H5Screate_simple(axes, part.data(), nullptr), H5Sclose);
  const Handle type(type_of(kind_), H5Tclose);
  well = well && H5Sselect_hyperslab(all.get(), H5S_SELECT_SET, first.data(), nullptr, part.data(),
                                     nullptr) >= 0;
  well = well &&
         H5Dwrite(dataset_, type.get(), mine.get(), all.get(), H5P_DEFAULT, waiting_.data()) >= 0;
  if (!well) file_->wrong("rows cannot be written");
  waiting_.clear();
}

Hdf5File::Hdf5File(std::string path) : path_(std::move(path)) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it would print
  beside_ = path_ + ".part";
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_EARLIEST, H5F_LIBVER_V18);
  links_ = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links_, 1);
  H5Pset_char_encoding(links_, H5T_CSET_UTF8);
  // made here, and not by the library, for this user alone: it holds how somebody worked
  const int made_first = ::open(beside_.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600);
  if (made_first >= 0) ::close(made_first);
  file_ = H5Fcreate(beside_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get());
  if (file_ < 0) wrong("cannot be created; is the folder there, and may you write in it?");
}

Hdf5File::~Hdf5File() {
  close();
  std::error_code ignored;
  std::filesystem::remove(beside_, ignored);
}

void Hdf5File::wrong(const std::string& what) {
  if (trouble_.empty())
    trouble_ = errno != 0 ? fmt::format("{}: {} ({})", path_, what, std::strerror(errno))
                          : fmt::format("{}: {}", path_, what);
}

std::int64_t Hdf5File::create(const std::string& name, std::int64_t type, std::int64_t space,
                              std::int64_t properties) {
  if (!trouble_.empty()) return -1;
  errno = 0;
  const hid_t dataset =
      H5Dcreate2(file_, name.c_str(), type, space, links_, properties, H5P_DEFAULT);
  if (dataset < 0) wrong(name + " cannot be made");
  return dataset;
}

void Hdf5File::group(const std::string& name) {
  if (!trouble_.empty()) return;
  if (H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0) return;
  const Handle made(H5Gcreate2(file_, name.c_str(), links_, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (made.get() < 0) wrong(name + " cannot be made");
}

void Hdf5File::text(const std::string& name, const std::string& text) {
  const Handle type(text_type(), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose),
      properties(plain_properties(), H5Pclose);
  const Handle made(create(name, type.get(), space.get(), properties.get()), H5Dclose);
  const char* const one = text.c_str();
  if (made.get() >= 0 && H5Dwrite(made.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &one) < 0)
    wrong(name + " cannot be written");
}

void Hdf5File::texts(const std::string& name, std::span<const std::string> texts) {
  const hsize_t many = texts.size();
  const Handle type(text_type(), H5Tclose), space(H5Screate_simple(1, &many, nullptr), H5Sclose),
      properties(plain_properties(), H5Pclose);
  const Handle made(create(name, type.get(), space.get(), properties.get()), H5Dclose);
  std::vector<const char*> all;
  all.reserve(texts.size());
  for (const std::string& text : texts) all.push_back(text.c_str());
  if (made.get() >= 0 && !all.empty() &&
      H5Dwrite(made.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0)
    wrong(name + " cannot be written");
}

void Hdf5File::numbers(const std::string& name, std::span<const double> values,
                       std::vector<std::uint64_t> shape) {
  const std::vector<hsize_t> size(shape.begin(), shape.end());
  const Handle space(size.empty()
                         ? H5Screate(H5S_SCALAR)
                         : H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr),
                     H5Sclose);
  const Handle properties(plain_properties(), H5Pclose);
  const Handle made(create(name, H5T_IEEE_F64LE, space.get(), properties.get()), H5Dclose);
  if (made.get() >= 0 &&
      H5Dwrite(made.get(), H5T_IEEE_F64LE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    wrong(name + " cannot be written");
}

void Hdf5File::note(const std::string& name, const char* key, const std::string& text) {
  if (!trouble_.empty()) return;
  const Handle type(text_type(), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle object(H5Oopen(file_, name.c_str(), H5P_DEFAULT), H5Oclose);
  const Handle made(
      H5Acreate2(object.get(), key, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* const one = text.c_str();
  if (made.get() < 0 || H5Awrite(made.get(), type.get(), &one) < 0)
    wrong(name + ": its note cannot be written");
}

void Hdf5File::link(const std::string& name, const std::string& target) {
  if (!trouble_.empty()) return;
  if (H5Lcreate_soft(target.c_str(), file_, name.c_str(), links_, H5P_DEFAULT) < 0)
    wrong(name + " cannot be made");
}

Column& Hdf5File::column(const std::string& name, Kind kind, std::vector<std::uint64_t> row_shape,
                         std::size_t rows_at_once) {
  Column& made = columns_.emplace_back();
  made.file_ = this;
  made.kind_ = kind;
  made.row_bytes_ = bytes_of(kind);
  for (const std::uint64_t size : row_shape) made.row_bytes_ *= size;
  made.rows_at_once_ = rows_at_once;
  made.row_shape_ = std::move(row_shape);
  const std::vector<hsize_t> none = shape_with(0, made.row_shape_),
                             most = shape_with(H5S_UNLIMITED, made.row_shape_),
                             part = shape_with(rows_at_once, made.row_shape_);
  const int axes = static_cast<int>(none.size());
  const Handle space(H5Screate_simple(axes, none.data(), most.data()), H5Sclose);
  const Handle properties(plain_properties(), H5Pclose), type(type_of(kind), H5Tclose);
  H5Pset_chunk(properties.get(), axes, part.data());
  if (made.row_bytes_ > 1) H5Pset_shuffle(properties.get());
  H5Pset_deflate(properties.get(), 4);
  made.dataset_ = create(name, type.get(), space.get(), properties.get());
  return made;
}

void Hdf5File::close() {
  for (Column& column : columns_)
    if (column.dataset_ >= 0 && H5Dclose(std::exchange(column.dataset_, -1)) < 0)
      wrong("a column cannot be closed");
  if (links_ >= 0) H5Pclose(std::exchange(links_, -1));
  if (file_ >= 0 && H5Fclose(std::exchange(file_, -1)) < 0) wrong("cannot be closed");
}

Status Hdf5File::finish() {
  errno = 0;
  for (Column& column : columns_) column.flush();
  close();
  if (!trouble_.empty()) return error(Trouble::io, trouble_);
  return record::rename_and_sync(beside_, path_);
}

}  // namespace burr::dataset
