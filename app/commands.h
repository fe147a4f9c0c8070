#pragma once
// The sub-commands of `meniscus`, one .cpp each. `arguments` are those after the command's name. They return
// the process's exit code and throw Error for what ends the run with one line on stderr.

#include <string>
#include <vector>

namespace meniscus {

int runRender(const std::vector<std::string>& arguments);
int runInfo(const std::vector<std::string>& arguments);
/// Only where there is MENISCUS_VIEWER.
int runView(const std::vector<std::string>& arguments);
int runDoctor(const std::vector<std::string>& arguments);
int runMeasure(const std::vector<std::string>& arguments);

/// "0.1.0"
const char* version();

}  // namespace meniscus
