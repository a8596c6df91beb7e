// base/new_file.h - writes a file completely or not at all: into a temporary file in the same
// folder, which is then renamed.
//
//     Result<base::NewFile> file = base::NewFile::create(path);
//     if (!file) return file.error();
//     file->write(data, size);                         // a failure is remembered
//     return file->put_in_place();                     // ... and reported here
//
// Without put_in_place() the temporary file is deleted with the object: a cancelled or failed
// export leaves nothing behind, and an older file of that name stays unchanged. Symbolic links are
// followed; devices, pipes, folders, and files that burr has read (base/inputs.h) are refused. Thread: one. Errors: Trouble::io with the path
// and the system's reason.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"

namespace burr::base {

// Who may read a new file. What holds people (sessions, marks, names, a patient's bone that nobody asked to
// export) is for this user alone, which is also what a writer gets that does not say. A bone, a picture or a
// table without people that somebody exports follows the umask, as files of other programs do.
inline constexpr unsigned kForMe = 0600, kForAll = 0666;

class NewFile {
 public:
  // Opens an empty file in the folder of `path`.
  [[nodiscard]] static Result<NewFile> create(const std::string& path, unsigned mode = kForMe);

  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&&) = delete;
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  // Appends. After the first failure nothing more is written; ok() then returns false.
  void write(const void* data, std::size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  // Overwrites bytes written earlier, for example a count in a header that is known only at the
  // end.
  void write_at(std::size_t offset, const void* data, std::size_t size);
  [[nodiscard]] bool ok() const { return trouble_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_ + buffer_.size(); }  // so far  [byte]

  // Flushes to the disk and renames. Do not write afterwards.
  [[nodiscard]] Status put_in_place();

 private:
  NewFile(std::string place, std::string beside, int file);
  void flush();
  [[nodiscard]] Error failed(const char* doing) const;

  std::string place_, beside_;
  int file_ = -1;
  int trouble_ = 0;  // errno of the first failure
  std::size_t size_ = 0;
  std::vector<char> buffer_;
};

}  // namespace burr::base
