#include "app/measure/csv.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/error.h"
#include "io/output_file.h"

namespace meniscus::measure {

namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out + '"';
}

Row parseLine(std::string_view line) {
  Row row(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      row.back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      row.emplace_back();
    } else {
      row.back() += c;
    }
  }
  return row;
}

}  // namespace

std::string csvLine(const Row& row) {
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) line += (i > 0 ? "," : "") + field(row[i]);
  return line + '\n';
}

std::vector<Row> parseCsv(std::string_view text) {
  std::vector<Row> rows;
  for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1))
    rows.push_back(parseLine(text.substr(0, end)));
  return rows;
}

std::string numberText(double value) {
  return std::isnan(value) ? "" : fmt::format("{}", value);
}

GrowingCsv::GrowingCsv(std::filesystem::path path, Row header)
    : path_(std::move(path)), header_(std::move(header)) {
  std::string text;
  if (std::ifstream file(path_, std::ios::binary); file)
    text.assign(std::istreambuf_iterator<char>(file), {});
  rows_ = parseCsv(text);
  const std::size_t whole = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  if (!rows_.empty()) {
    if (rows_.front() != header_)
      throw InputError(fmt::format("'{}' has other columns than this version writes; give -o another folder",
                                   path_.string()));
    rows_.erase(rows_.begin());
    // What is short of a field was cut off in a way that no line end shows.
    std::erase_if(rows_, [&](const Row& row) { return row.size() != header_.size(); });
    if (whole != text.size() && truncate(path_.c_str(), static_cast<off_t>(whole)) != 0)
      throwWriteError(path_, errno);
  } else {
    writeTextFile(path_, csvLine(header_));
  }
  open();
}

GrowingCsv::~GrowingCsv() {
  if (descriptor_ >= 0) close(descriptor_);
}

void GrowingCsv::open() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor_ < 0) throwWriteError(path_, errno);
}

void GrowingCsv::append(const std::vector<Row>& rows) {
  std::string text;
  for (const Row& row : rows) {
    MENISCUS_CHECK(row.size() == header_.size());
    text += csvLine(row);
  }
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(descriptor_, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) throwWriteError(path_, errno);
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  // Not every file system can (EINVAL); the rows are in the file then as well.
  if (fsync(descriptor_) != 0 && errno != EINVAL) throwWriteError(path_, errno);
  rows_.insert(rows_.end(), rows.begin(), rows.end());
}

void GrowingCsv::keepIf(const std::function<bool(const Row&)>& keep) {
  const std::size_t before = rows_.size();
  std::erase_if(rows_, [&](const Row& row) { return !keep(row); });
  if (rows_.size() == before) return;
  std::string text = csvLine(header_);
  for (const Row& row : rows_) text += csvLine(row);
  writeTextFile(path_, text);
  open();
}

}  // namespace meniscus::measure
