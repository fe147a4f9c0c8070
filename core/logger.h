#pragma once
// Oddities met on the way (in a structure file, in a setting) are collected, shown and asserted in
// tests; they are never printed where they occur.

#include <string>
#include <utility>
#include <vector>

namespace meniscus {

/// Collects notes in the order in which they occur; passed by reference to whatever may meet an oddity.
class Logger {
 public:
  /// One line, no trailing newline, naming the place if there is one ("line 12: ...").
  void note(std::string line) { notes_.push_back(std::move(line)); }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::vector<std::string> notes_;
};

}  // namespace meniscus
