// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_page.hpp"

#include <string_view>
#include <system_error>

#include "config/text_file.hpp"
#include "tools/palpate/command.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPlace = "@PALPATE_REPORT@";
constexpr const char* kFixPage =
    "install node (Debian package nodejs) and build the target report_bundle, once with a network";

/// JSON in which no "<" is left: "</script>" in a name would end the element.
std::string for_html(const nlohmann::ordered_json& data) {
  const std::string text =
      data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

fs::path page_file(const char* name) {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& page : {folder / name, folder / "../share/palpate" / name}) {
    if (fs::exists(page, error)) return page;
  }
  throw Failure(kOther, "this build has no page to show", (folder / name).string(), kFixPage);
}

}  // namespace

fs::path report_page() { return page_file("report.html"); }
fs::path live_page() { return page_file("live.html"); }

std::string fill_page(const fs::path& page, const nlohmann::ordered_json& data) {
  std::string text;
  if (const std::error_code error = config::read_text(page, text)) {
    throw Failure(kOther, "cannot read the page (" + error.message() + ")", page.string(),
                  kFixPage);
  }
  const std::size_t place = text.find(kPlace);
  if (place == std::string::npos || text.find(kPlace, place + 1) != std::string::npos) {
    throw Failure(kOther, "not a page of palpate", page.string(), kFixPage);
  }
  return text.replace(place, kPlace.size(), for_html(data));
}

}  // namespace palpate::cli
