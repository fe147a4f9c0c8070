#pragma once
// A CSV file as the report reads it: rows by number, fields by the column's name.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "app/measure/csv.h"

namespace meniscus::measure {

class Table {
 public:
  /// Empty if there is no such file.
  explicit Table(const std::filesystem::path& path);

  std::size_t size() const { return rows_.size(); }
  bool empty() const { return rows_.empty(); }
  const Row& row(std::size_t i) const { return rows_[i]; }
  /// "" if there is no such row or column.
  const std::string& text(std::size_t i, std::string_view column) const;
  /// NaN if it is not a number.
  double number(std::size_t i, std::string_view column) const;
  /// The row's line in the file, counted from 1.
  static std::size_t lineOf(std::size_t i) { return i + 2; }
  /// "points.csv:7"
  std::string source(std::size_t i) const;

 private:
  std::string name_;
  Row header_;
  std::vector<Row> rows_;
};

}  // namespace meniscus::measure
