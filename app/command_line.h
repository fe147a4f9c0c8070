#pragma once
// What the commands share in reading their arguments with CLI11. Only for .cpp files that define options:
// CLI11 is slow to compile.

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

namespace meniscus {

/// A parser for `meniscus NAME` with our layout of --help. `examples` ends the help.
std::unique_ptr<CLI::App> makeCommandLine(const std::string& name, const std::string& description,
                                          const std::string& examples);

/// Runs the parser. Returns false after printing the help that was asked for; throws UsageError, one line,
/// for what does not fit. What the options' own functions throw passes through.
bool parseCommandLine(CLI::App& app, const std::vector<std::string>& arguments);

}  // namespace meniscus
