#include "app/measure/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace meniscus::measure {

Table::Table(const std::filesystem::path& path) : name_(path.filename().string()) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return;
  rows_ = parseCsv(std::string{std::istreambuf_iterator<char>(file), {}});
  if (rows_.empty()) return;
  header_ = rows_.front();
  rows_.erase(rows_.begin());
}

const std::string& Table::text(std::size_t i, std::string_view column) const {
  static const std::string kNothing;
  const auto found = std::find(header_.begin(), header_.end(), column);
  const auto at = static_cast<std::size_t>(found - header_.begin());
  return found != header_.end() && i < rows_.size() && at < rows_[i].size() ? rows_[i][at] : kNothing;
}

double Table::number(std::size_t i, std::string_view column) const {
  const std::string& value = text(i, column);
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return value.empty() || *end != 0 ? std::nan("") : number;
}

std::string Table::source(std::size_t i) const {
  return fmt::format("{}:{}", name_, lineOf(i));
}

}  // namespace meniscus::measure
