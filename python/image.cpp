// SPDX-License-Identifier: Apache-2.0
#include "image.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <new>

namespace palpate::python {
namespace {

constexpr std::size_t kBoundary = 64;

[[noreturn]] void raise_os_error(const std::string& path) {
  PyErr_SetFromErrnoWithFilename(PyExc_OSError, path.c_str());
  throw py::error_already_set();
}

/// The file's bytes, read-only; they are unmapped with the last owner.
std::shared_ptr<const void> mapped(const std::string& path, std::size_t& size) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) raise_os_error(path);
  struct stat about {};
  if (::fstat(file, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size == 0) {
    ::close(file);
    throw Refused(path + ": not a file with anything in it: give an image of 'palpate bake'");
  }
  size = static_cast<std::size_t>(about.st_size);
  void* const memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
  const int error = errno;
  ::close(file);
  if (memory == MAP_FAILED) {
    errno = error;
    raise_os_error(path);
  }
  return {memory, [bytes = size](const void* m) { ::munmap(const_cast<void*>(m), bytes); }};
}

}  // namespace

Image::Image(const py::object& path)
    : name_(py::str(py::module_::import("os").attr("fspath")(path))) {
  memory_ = mapped(name_, size_);
  prove();
}

Image::Image(const py::buffer& bytes) : name_("bytes") {
  auto held = std::make_shared<py::buffer_info>(bytes.request());
  size_ = static_cast<std::size_t>(held->size * held->itemsize);
  const bool contiguous = PyBuffer_IsContiguous(held->view(), 'C') != 0;
  if (!contiguous) throw Refused("bytes: not contiguous: give the image's bytes one by one");
  if (reinterpret_cast<std::uintptr_t>(held->ptr) % kBoundary == 0) {
    memory_ = std::shared_ptr<const void>(held, held->ptr);
  } else {
    constexpr std::align_val_t kAlignment{kBoundary};
    void* const copy = ::operator new(size_ + 1, kAlignment);
    memory_ = {copy, [](const void* m) {
                 ::operator delete (const_cast<void*>(m), std::align_val_t{kBoundary});
               }};
    std::memcpy(copy, held->ptr, size_);
  }
  prove();
}

std::shared_ptr<Image> Image::from_bytes(const py::buffer& bytes) {
  return std::shared_ptr<Image>(new Image(bytes));
}

void Image::prove() {
  palpate_status status = PALPATE_OK;
  {
    const py::gil_scoped_release others_run;
    status = palpate_open(memory_.get(), size_, &view_);
  }
  if (status != PALPATE_OK) {
    throw Refused(name_ + ": image refused, " + palpate_describe(status) +
                  ": give an image of 'palpate bake' of this version");
  }
}

}  // namespace palpate::python
