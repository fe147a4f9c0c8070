#include "app/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <numeric>

#include "core/error.h"

namespace meniscus {
namespace {

/// CLI11's layout with the value's form instead of its C++ type, and no remarks of its own after it.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(32); }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_type_name().empty() || option->get_positional() ? "" : " " + option->get_type_name();
  }
  std::string make_option_name(const CLI::Option* option, bool positional) const override {
    return CLI::detail::find_and_replace(CLI::Formatter::make_option_name(option, positional), ",", ", ");
  }
  std::string make_usage(const CLI::App* app, std::string) const override {
    std::string files;
    for (const CLI::Option* option : app->get_options({}))
      if (option->get_positional()) files += " " + option->get_type_name();
    return "Usage: " + app->get_name() + files + " [options]\n";
  }
};

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row.back();
}

std::string closestOption(const CLI::App& app, const std::string& unknown) {
  std::string closest;
  std::size_t least = 3;  // further away than two letters, a guess does not help
  for (const CLI::Option* option : app.get_options({})) {
    for (const std::string& name : option->get_lnames()) {
      const std::size_t distance = editDistance("--" + name, unknown);
      if (distance >= least) continue;
      least = distance;
      closest = "--" + name;
    }
  }
  return closest;
}

[[noreturn]] void throwUnexpected(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining();
  const std::string argument = left.empty() ? "" : left.front().substr(0, left.front().find('='));
  if (!argument.starts_with('-'))
    throw UsageError(fmt::format("'{}' is one argument too many; see {} --help", argument, app.get_name()));
  const std::string guess = closestOption(app, argument);
  const std::string remedy =
      guess.empty() ? fmt::format("see {} --help", app.get_name()) : fmt::format("did you mean {}?", guess);
  throw UsageError(fmt::format("there is no option '{}'; {}", argument, remedy));
}

// CLI11 names the option in the text of the error only, as its first word.
[[noreturn]] void throwMissingValue(const CLI::App& app, const std::string& message) {
  const std::string name = message.substr(0, message.find_first_of(": "));
  for (const CLI::Option* option : app.get_options({})) {
    if (!option->check_name(name)) continue;
    if (option->get_items_expected_max() == 0) throw UsageError(fmt::format("{}: takes no value", name));
    std::string allowed = option->get_description();
    std::replace(allowed.begin(), allowed.end(), '\n', ' ');
    // The usual cause: a shell takes an unquoted #RRGGBB for a comment.
    const char* quoting = allowed.find('#') != std::string::npos ? " (with its quotes)" : "";
    throw UsageError(fmt::format("{}: needs a value: {}{}", name, allowed, quoting));
  }
  throw UsageError(message);
}

}  // namespace

std::unique_ptr<CLI::App> makeCommandLine(const std::string& name, const std::string& description,
                                          const std::string& examples) {
  auto app = std::make_unique<CLI::App>(description, "meniscus " + name);
  app->formatter(std::make_shared<HelpFormatter>());
  app->footer("Examples:\n" + examples);
  app->set_help_flag();  // added last by parseCommandLine, so that it is listed last
  app->get_formatter()->label("Positionals", "Input");
  return app;
}

bool parseCommandLine(CLI::App& app, const std::vector<std::string>& arguments) {
  app.set_help_flag("-h,--help", "Show this help")->group("Other");
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(std::move(reversed));
    return true;
  } catch (const CLI::CallForHelp&) {
    const std::string help = CLI::detail::find_and_replace(app.help(), "\n\n\n", "\n\n");
    std::fwrite(help.data(), 1, help.size(), stdout);
    return false;
  } catch (const CLI::ExtrasError&) {
    throwUnexpected(app);
  } catch (const CLI::ArgumentMismatch& error) {
    throwMissingValue(app, error.what());
  } catch (const CLI::ParseError& error) {
    std::string line = error.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    throw UsageError(fmt::format("{}; see {} --help", line, app.get_name()));
  }
}

}  // namespace meniscus
