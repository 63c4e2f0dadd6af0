#include "model/urdf_tree.hpp"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include "files/bounded_file.hpp"

namespace pmg::model {
namespace {

/// Keeps urdfdom's error message, which otherwise goes to stderr only, for the exception.
class Listener final : public console_bridge::OutputHandler {
 public:
  Listener() { console_bridge::useOutputHandler(this); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && said.empty()) said = text;
  }
  std::string said;
};

files::Place place_in(const UrdfTree& tree, std::size_t at) {
  const std::size_t newline = at == 0 ? std::string::npos : tree.text.rfind('\n', at - 1);
  const auto lines = std::count(tree.text.begin(), tree.text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  return {tree.file.string(), static_cast<int>(lines) + 1,
          static_cast<int>(newline == std::string::npos ? at : at - newline - 1) + 1};
}

constexpr std::ptrdiff_t kMostLinks = 256;  // a humanoid with two hands of 25 joints each has some 90
constexpr int kDeepestElement = 32;         // URDF's own nest five deep

constexpr std::string_view kXmlSpaces = " \t\r\n\v\f";

/// (text, place of a '<') => (place of the last byte of what begins there: a comment, raw text, a declaration or a tag,
/// whose values in quotes may hold '>'). The text's last byte when it has no end.
std::size_t end_of_markup(std::string_view text, std::size_t at) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kNoTags = {
      {{"<!--", "-->"}, {"<![CDATA[", "]]>"}, {"<!", ">"}, {"<?", ">"}}};
  for (const auto& [begin, end] : kNoTags) {
    if (!text.substr(at).starts_with(begin)) continue;
    const std::size_t found = text.find(end, at + begin.size());
    return found == std::string_view::npos ? text.size() - 1 : found + end.size() - 1;
  }
  char quote = '\0';
  for (; at < text.size(); ++at) {
    if (quote != '\0') {
      if (text[at] == quote) quote = '\0';
    } else if (text[at] == '"' || text[at] == '\'') {
      quote = text[at];
    } else if (text[at] == '>') {
      return at;
    }
  }
  return text.size() - 1;
}

/// Bounds what parsers recurse over or search again and again: links, and the nesting of elements.
void check_extent(const UrdfTree& tree) {
  const std::string_view text = tree.text;
  int depth = 0;
  std::ptrdiff_t links = 0;
  std::size_t end = 0;
  for (std::size_t at = text.find('<'); at != std::string_view::npos; at = text.find('<', end + 1)) {
    end = end_of_markup(text, at);
    if (text.substr(at).starts_with("<!") || text.substr(at).starts_with("<?")) continue;
    std::string_view inner = text.substr(at + 1, end - std::min(at + 1, end));
    inner.remove_prefix(std::min(inner.find_first_not_of(kXmlSpaces), inner.size()));
    if (inner.starts_with('/')) {
      --depth;
    } else if (!inner.ends_with('/')) {
      ++depth;
    }
    const std::size_t name_end = inner.find_first_of(" \t\r\n\v\f/");
    links += inner.substr(0, name_end) == "link" ? 1 : 0;
    if (depth > kDeepestElement) {
      files::raise(place_in(tree, at), "", fmt::format("is {} elements deep", depth),
                   fmt::format("{} at most", kDeepestElement));
    }
    if (links > kMostLinks) {
      files::raise(place_in(tree, at), "link", fmt::format("is number {}", links),
                   fmt::format("{} at most", kMostLinks));
    }
  }
}

/// Links in a cycle of their own hang on no root; urdfdom takes them without a word. They own each other: they are cut
/// apart, or their memory would never be freed.
void check_all_reached(const UrdfTree& tree) {
  for (const auto& [name, link] : tree.urdf->links_) {
    if (tree.link_pose.contains(name)) continue;
    for (const auto& [any_name, any_link] : tree.urdf->links_) any_link->child_links.clear();
    files::raise(tree.place("link", name), "link " + name, "is not connected to the root link",
                 fmt::format("a chain of joints from {}", tree.urdf->getRoot()->name));
  }
}

/// Checks the numbers in the text: urdfdom accepts `nan`, and reports other slips without their place.
void check_numbers(const UrdfTree& tree) {
  for (const std::string name : {"value", "xyz", "rpy", "lower", "upper", "effort", "velocity", "ixx", "ixy", "ixz",
                                 "iyy", "iyz", "izz", "radius", "length", "size", "rgba"}) {
    const std::string opening = " " + name + "=\"";
    for (std::size_t at = tree.text.find(opening); at != std::string::npos; at = tree.text.find(opening, at + 1)) {
      const std::size_t start = at + opening.size(), end = tree.text.find('"', start);
      const std::string text = tree.text.substr(start, end - start);
      std::istringstream words(text);
      for (std::string word; words >> word;) {
        const char* first = word.data() + (word.front() == '+' ? 1 : 0);
        const char* last = word.data() + word.size();
        double value = 0.0;
        const auto [stop, error] = std::from_chars(first, last, value);
        if (error != std::errc() || stop != last || !std::isfinite(value)) {
          files::raise(place_in(tree, at + 1), name, fmt::format("is '{}'", text), "finite numbers");
        }
      }
    }
  }
}

KDL::Vector to_kdl(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

KDL::Frame to_kdl(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w), to_kdl(pose.position)};
}

KDL::RigidBodyInertia to_kdl(const urdf::Inertial& inertial) {
  const KDL::Frame origin = to_kdl(inertial.origin);
  const KDL::RotationalInertia at_com(inertial.ixx, inertial.iyy, inertial.izz, inertial.ixy, inertial.ixz,
                                      inertial.iyz);
  // KDL rotates a RigidBodyInertia but not a RotationalInertia, so a body without mass is rotated.
  const KDL::RigidBodyInertia turned = origin.M * KDL::RigidBodyInertia(0.0, KDL::Vector::Zero(), at_com);
  return KDL::RigidBodyInertia(inertial.mass, origin.p, turned.getRotationalInertia());
}

KDL::Joint to_kdl(const urdf::Joint& joint, const KDL::Frame& origin) {
  if (joint.type == urdf::Joint::FIXED) return KDL::Joint(joint.name, KDL::Joint::Fixed);
  return {joint.name, origin.p, origin.M * to_kdl(joint.axis), KDL::Joint::RotAxis};
}

/// Positive mass, and principal moments that obey the triangle inequality. Others belong to no mass distribution, so
/// they are typing errors.
void check_inertia(const UrdfTree& tree, const urdf::Link& link) {
  const files::Place place = tree.place("link", link.name);
  const std::string key = "link " + link.name + " inertial";
  if (!link.inertial) files::raise(place, key, "is missing", "mass, origin and inertia");
  const urdf::Inertial& body = *link.inertial;
  if (!(body.mass > 0.0) || !std::isfinite(body.mass)) {
    files::raise(place, key + " mass", fmt::format("is {}", body.mass), "a mass above 0 kg");
  }
  Eigen::Matrix3d inertia;
  inertia << body.ixx, body.ixy, body.ixz, body.ixy, body.iyy, body.iyz, body.ixz, body.iyz, body.izz;
  if (!inertia.allFinite()) files::raise(place, key + " inertia", "isn't finite", "finite numbers");
  const Eigen::Vector3d moments =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  if (moments[0] <= 0.0 || moments[0] + moments[1] < moments[2] * (1.0 - 1e-6)) {
    files::raise(place, key + " inertia",
                 fmt::format("has the principal moments {}, {}, {}", moments[0], moments[1], moments[2]),
                 "three positive ones, none above the sum of the others");
  }
}

void check_joint(const UrdfTree& tree, const urdf::Joint& joint) {
  if (joint.type == urdf::Joint::FIXED) return;
  const files::Place place = tree.place("joint", joint.name);
  const std::string key = "joint " + joint.name;
  if (joint.type != urdf::Joint::REVOLUTE) files::raise(place, key + " type", "isn't supported", "revolute or fixed");
  if (!(std::abs(to_kdl(joint.axis).Norm() - 1.0) < 1e-6)) {
    files::raise(place, key + " axis", fmt::format("has the length {}", to_kdl(joint.axis).Norm()), "a unit vector");
  }
  if (!joint.limits) files::raise(place, key + " limit", "is missing", "lower, upper, effort and velocity");
  const urdf::JointLimits& limit = *joint.limits;
  if (!(limit.lower < limit.upper) || !std::isfinite(limit.lower) || !std::isfinite(limit.upper)) {
    files::raise(place, key + " limit", fmt::format("has lower {} and upper {}", limit.lower, limit.upper),
                 "lower < upper");
  }
  if (!(limit.effort > 0.0) || !std::isfinite(limit.effort)) {
    files::raise(place, key + " limit effort", fmt::format("is {}", limit.effort), "a number above 0");
  }
  if (!(limit.velocity > 0.0) || !std::isfinite(limit.velocity)) {
    files::raise(place, key + " limit velocity", fmt::format("is {}", limit.velocity), "a number above 0");
  }
}

void add_children(UrdfTree& tree, const urdf::Link& parent) {
  for (const urdf::LinkSharedPtr& link : parent.child_links) {
    const urdf::Joint& joint = *link->parent_joint;
    check_joint(tree, joint);
    check_inertia(tree, *link);
    const KDL::Frame origin = to_kdl(joint.parent_to_joint_origin_transform);
    tree.tree.addSegment(KDL::Segment(link->name, to_kdl(joint, origin), origin, to_kdl(*link->inertial)), parent.name);
    tree.link_pose[link->name] = tree.link_pose.at(parent.name) * origin;
    add_children(tree, *link);
  }
}

}  // namespace

files::Place UrdfTree::place(const std::string& element, const std::string& name) const {
  const std::string opening = "<" + element + " ";
  for (std::size_t at = text.find(opening); at != std::string::npos; at = text.find(opening, at + 1)) {
    const std::string tag = text.substr(at, text.find('>', at) - at);
    if (tag.find("name=\"" + name + "\"") == std::string::npos) continue;
    return place_in(*this, at);
  }
  return {file.string()};
}

UrdfTree read_urdf(const std::filesystem::path& file) {
  UrdfTree tree;
  tree.file = file;
  tree.text = files::read_bounded_text(file, files::kLargestUrdf_bytes, "a URDF file");
  check_extent(tree);
  check_numbers(tree);

  Listener listener;
  tree.urdf = urdf::parseURDF(tree.text);
  if (!tree.urdf || !tree.urdf->getRoot()) {
    files::raise({file.string()}, "", listener.said.empty() ? "isn't a robot" : listener.said,
                 "a URDF robot with one root link");
  }
  const urdf::Link& root = *tree.urdf->getRoot();
  check_inertia(tree, root);
  tree.tree = KDL::Tree(root.name);
  tree.root_inertia = to_kdl(*root.inertial);
  tree.link_pose[root.name] = KDL::Frame::Identity();
  add_children(tree, root);
  check_all_reached(tree);
  return tree;
}

}  // namespace pmg::model
