#pragma once
// Where the project's own files are: in a library of its own, so that no other object changes with the folder
// that the project is built in (ccache).

#include <string>

namespace meniscus::test {

/// Full name of one of the project's files or folders, "docs/scene.md".
std::string projectFile(const std::string& name);

/// The program that is tested.
std::string program();

}  // namespace meniscus::test
