// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/image_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <string>
#include <system_error>

#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

constexpr std::align_val_t kAlignment{image::kAlignment};

[[noreturn]] void refuse(const std::string& what, const std::filesystem::path& file,
                         const std::string& fix) {
  throw Failure(kRefused, what, file.string(), fix);
}

std::string fix_for(Status status) {
  switch (status) {
    case Status::image_bad_magic:
    case Status::image_too_small:
      return "give an image made by 'palpate bake'";
    case Status::image_bad_version:
    case Status::image_bad_byte_order:
    case Status::image_over_limit:
      return "bake the mesh again with this version";
    default:
      return "copy or bake the image again";
  }
}

std::size_t size_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) refuse("no such image", file, "check the path");
  if (!std::filesystem::is_regular_file(status)) {
    refuse("image is not a regular file", file, "give the path of a .palp file");
  }
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) refuse("cannot read image (" + error.message() + ")", file, "check its permissions");
  return static_cast<std::size_t>(size);
}

}  // namespace

void ImageFile::Free::operator()(std::byte* memory) const { ::operator delete(memory, kAlignment); }

ImageFile::ImageFile(const std::filesystem::path& file) : size_(size_of(file)) {
  memory_.reset(static_cast<std::byte*>(::operator new(size_, kAlignment)));
  std::ifstream in(file, std::ios::binary);
  in.read(static_cast<char*>(static_cast<void*>(memory_.get())),
          static_cast<std::streamsize>(size_));
  if (!in) {
    refuse(std::string("cannot read image (") + std::strerror(errno) + ")", file,
           "check its permissions and that nothing writes to it");
  }
  if (const Status status = validate(bytes(), view_); status != Status::ok) {
    refuse(std::string("image refused, ") + describe(status), file, fix_for(status));
  }
}

}  // namespace palpate::cli
