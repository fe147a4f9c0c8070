#pragma once
// Tables as comma-separated values (RFC 4180, lines end with \n), among them one that grows row by row and
// survives being cut off at any moment.

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace meniscus::measure {

using Row = std::vector<std::string>;

/// One line with its \n; fields are quoted where they must be.
std::string csvLine(const Row& row);

/// The finished lines of a text; what follows the last \n is left out. A quoted field may not hold a \n.
std::vector<Row> parseCsv(std::string_view text);

/// The shortest text that gives the same double back; empty if it is not a number.
std::string numberText(double value);

/// A file that rows are appended to, each for good: append() returns after the operating system has it on
/// the disk. Throws InputError.
class GrowingCsv {
 public:
  /// Opens or creates it. A last line without its end is cut off. Throws InputError if the file's header is
  /// another one.
  GrowingCsv(std::filesystem::path path, Row header);
  ~GrowingCsv();
  GrowingCsv(const GrowingCsv&) = delete;
  GrowingCsv& operator=(const GrowingCsv&) = delete;

  const std::vector<Row>& rows() const { return rows_; }
  void append(const std::vector<Row>& rows);
  /// Drops the rows for which `keep` is false; the file changes at once or not at all.
  void keepIf(const std::function<bool(const Row&)>& keep);

 private:
  void open();
  std::filesystem::path path_;
  Row header_;
  std::vector<Row> rows_;
  int descriptor_ = -1;
};

}  // namespace meniscus::measure
