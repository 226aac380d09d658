#include "config/json.hpp"

#include <cmath>

namespace sandhopper {

nlohmann::ordered_json to_json(const ConfigNode& node) {
  using Json = nlohmann::ordered_json;
  switch (node.kind) {
    case ConfigNode::Kind::real:
      return std::isfinite(node.real) ? Json(node.real) : Json(nullptr);
    case ConfigNode::Kind::integer:
      return node.integer;
    case ConfigNode::Kind::boolean:
      return node.boolean;
    case ConfigNode::Kind::text:
    case ConfigNode::Kind::date:
      return node.text;
    case ConfigNode::Kind::array: {
      auto array = Json::array();
      for (const auto& child : node.children) array.push_back(to_json(child));
      return array;
    }
    case ConfigNode::Kind::table:
      break;
  }
  auto object = Json::object();
  for (const auto& child : node.children) object[child.key] = to_json(child);
  return object;
}

}  // namespace sandhopper
