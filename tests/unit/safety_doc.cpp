// SPDX-License-Identifier: GPL-3.0-or-later
// docs/SAFETY.md names a guard and a test for every hazard, and the tests are there; other pages
// keep their own rules.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace palpate::test {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// "Suite.test" and "Suite.*" of every test in the sources.
std::set<std::string> tests_that_exist() {
  const std::regex test(R"(\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\))");
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(PALPATE_TESTS)) {
    if (entry.path().extension() != ".cpp") continue;
    const std::string text = text_of(entry.path());
    for (std::sregex_iterator i(text.begin(), text.end(), test), end; i != end; ++i) {
      names.insert((*i)[1].str() + "." + (*i)[2].str());
      names.insert((*i)[1].str() + ".*");
    }
  }
  return names;
}

/// The rows of the table of hazards.
std::vector<std::string> hazards() {
  std::istringstream page(text_of(PALPATE_DOCS "/SAFETY.md"));
  std::vector<std::string> rows;
  bool in_table = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("## ", 0) == 0) in_table = line == "## Hazards";
    if (in_table && line.rfind("| ", 0) == 0) rows.push_back(line);
  }
  return rows;
}

TEST(SafetyPage, every_hazard_has_tests_that_exist) {
  const std::set<std::string> exist = tests_that_exist();
  const std::vector<std::string> rows = hazards();
  ASSERT_GT(rows.size(), 20u);
  const std::regex quoted(R"(`(\w+\.[\w*]+)`)");
  for (std::size_t i = 2; i < rows.size(); ++i) {  // below the heading
    std::size_t named = 0;
    const std::string tests = rows[i].substr(rows[i].rfind(" | "));
    for (std::sregex_iterator t(tests.begin(), tests.end(), quoted), end; t != end; ++t, ++named) {
      EXPECT_TRUE(exist.count((*t)[1].str()) > 0) << (*t)[1].str() << " of: " << rows[i];
    }
    EXPECT_GT(named, 0u) << rows[i];
  }
}

// Without -d it takes a file for another product.
TEST(Documents, every_call_of_dfu_util_names_the_device) {
  const std::regex call(R"(dfu-util (-.*))");
  std::size_t calls = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PALPATE_DOCS)) {
    if (entry.path().extension() != ".md") continue;
    std::istringstream page(text_of(entry.path()));
    for (std::string line; std::getline(page, line);) {
      std::smatch found;
      if (!std::regex_search(line, found, call)) continue;
      ++calls;
      EXPECT_EQ(found[1].str().rfind("-d ", 0), 0u) << entry.path() << ": " << line;
    }
  }
  EXPECT_GT(calls, 0u);
}

}  // namespace
}  // namespace palpate::test
