#pragma once
// What was odd in a file, counted, so that a habit that fills a file makes one note.

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <vector>

#include "core/logger.h"

namespace meniscus {

class Oddities {
 public:
  /// `what` must be a string literal: it is told apart by its address. Line 0 = no particular line.
  void add(const char* what, std::size_t line) {
    for (Entry& entry : entries_) {
      if (entry.what == what) {
        ++entry.count;
        return;
      }
    }
    entries_.push_back({what, line, 1});
  }

  void report(Logger& logger) const {
    for (const Entry& entry : entries_) {
      if (entry.line == 0) {
        logger.note(entry.count == 1 ? std::string(entry.what)
                                     : fmt::format("{} ({} times)", entry.what, entry.count));
      } else if (entry.count == 1) {
        logger.note(fmt::format("line {}: {}", entry.line, entry.what));
      } else {
        logger.note(fmt::format("line {} and {} more: {}", entry.line, entry.count - 1, entry.what));
      }
    }
  }

 private:
  struct Entry {
    const char* what;
    std::size_t line;
    std::size_t count;
  };
  std::vector<Entry> entries_;
};

}  // namespace meniscus
