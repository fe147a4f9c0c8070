#pragma once
// The tree of a MolViewSpec scene (molstar.org/mol-view-spec-docs, major version 1): kinds of nodes, which
// stands under which, and what every node has.

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/scene/json_place.h"

namespace meniscus {

/// One node; its JSON must outlive it.
class MvsNode {
 public:
  /// Throws InputError if it is no object or a member that every node has is of a wrong type.
  explicit MvsNode(JsonPlace place);

  const JsonPlace& place() const { return place_; }
  const std::string& kind() const { return kind_; }
  const std::vector<MvsNode>& children() const { return children_; }

  /// A parameter; nothing if it is missing or null.
  std::optional<JsonPlace> find(std::string_view parameter) const;
  /// The same, failing if it is missing.
  JsonPlace at(std::string_view parameter) const;
  /// custom.meniscus
  std::optional<JsonPlace> meniscus() const;

  /// Adds the parameters that are not `known` to `unsupported`.
  void listOtherParameters(std::initializer_list<std::string_view> known,
                           std::vector<std::string>& unsupported) const;

 private:
  JsonPlace place_;
  std::string kind_;
  std::vector<MvsNode> children_;
};

/// Fails at the first node that is of no known kind (unless `lenient`: of a newer version), stands where its
/// kind may not, or whose ref another node has.
void checkTree(const MvsNode& root, bool lenient);

/// Whether files of this format, as a parse node names it, are read.
bool isReadFormat(std::string_view format);

}  // namespace meniscus
