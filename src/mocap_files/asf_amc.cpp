#include <fmt/format.h>

#include <array>
#include <map>
#include <numbers>

#include "mocap_files/motion.hpp"
#include "mocap_files/words.hpp"

namespace pmg::mocap {
namespace {

/// A bone leads from its parent's end by `offset`; it turns about its beginning.
struct Bone {
  std::string name;
  int parent = -1;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();          ///< in file axes at rest
  Eigen::Quaterniond axis = Eigen::Quaterniond::Identity();  ///< C
  std::vector<int> dof;                                      ///< 0..2: tx ty tz, 3..5: rx ry rz, 6: l
};

struct AsfSkeleton {
  std::vector<Bone> bones;  ///< bones[0] is the root
  double length = 1.0, angle_rad = std::numbers::pi / 180.0;
  int find(std::string_view name) const {
    for (std::size_t i = 0; i < bones.size(); ++i) {
      if (bones[i].name == name) return static_cast<int>(i);
    }
    return -1;
  }
};

int asf_dof(Words& words, std::string_view word) {
  constexpr std::array<std::string_view, 7> kNames = {"tx", "ty", "tz", "rx", "ry", "rz", "l"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (same_word(word, kNames[i])) return static_cast<int>(i);
  }
  words.fail(fmt::format("is '{}'", shown_word(word)), "one of tx, ty, tz, rx, ry, rz, l");
}

/// Rotation about fixed axes, x first: R = Rz Ry Rx for the order XYZ.
Eigen::Quaterniond asf_rotation(const Eigen::Vector3d& angles_rad, const std::string& order) {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < order.size() && i < 3; ++i) {
    q = Eigen::AngleAxisd(angles_rad[static_cast<int>(i)], Eigen::Vector3d::Unit((order[i] | 0x20) - 'x')) * q;
  }
  return q;
}

Eigen::Quaterniond asf_axis(Words& words, double angle_rad) {
  Eigen::Vector3d angles;
  for (int i = 0; i < 3; ++i) angles[i] = angle_rad * words.number("an angle of the axis");
  const std::string order(words.next("the order of the axis, as XYZ"));
  for (const char c : order) {
    if (order.size() != 3 || (c | 0x20) < 'x' || (c | 0x20) > 'z') words.fail("is no order of axes", "XYZ or the like");
  }
  return asf_rotation(angles, order);
}

bool asf_section(Words& words) { return words.end() || words.peek().front() == ':'; }

void asf_units(Words& words, AsfSkeleton& skeleton) {
  while (!asf_section(words)) {
    const std::string_view word = words.next("a unit");
    if (same_word(word, "length")) {
      skeleton.length = words.number("the unit of length");
      if (skeleton.length <= 0.0) words.fail("the unit of length is not above zero", "a positive number");
    } else if (same_word(word, "angle")) {
      const bool degrees = same_word(words.next("deg or rad"), "deg");
      skeleton.angle_rad = degrees ? std::numbers::pi / 180.0 : 1.0;
    } else {
      words.rest_of_line();
    }
  }
}

void asf_root(Words& words, AsfSkeleton& skeleton) {
  Bone& root = skeleton.bones.front();
  while (!asf_section(words)) {
    const std::string_view word = words.next("a key of :root");
    if (same_word(word, "order")) {
      for (int i = 0; i < 6; ++i) root.dof.push_back(asf_dof(words, words.next("six words of the root's order")));
    } else if (same_word(word, "orientation") || same_word(word, "position")) {
      for (int i = 0; i < 3; ++i) words.number("a number of the root");
    } else {
      words.rest_of_line();  // "axis XYZ": the root's own rotation has this order, as `order` repeats
    }
  }
}

Bone asf_bone(Words& words, double angle_rad) {
  Bone bone;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double length = 0.0;
  for (;;) {
    const std::string_view word = words.next("a key of the bone, or end");
    if (same_word(word, "end")) break;
    if (same_word(word, "name")) {
      bone.name = words.next("the bone's name");
    } else if (same_word(word, "direction")) {
      for (int i = 0; i < 3; ++i) direction[i] = words.number("three numbers of the direction");
    } else if (same_word(word, "length")) {
      length = words.number("the bone's length");
    } else if (same_word(word, "axis")) {
      bone.axis = asf_axis(words, angle_rad);
    } else if (same_word(word, "dof")) {
      std::string_view line = words.rest_of_line();
      for (std::size_t at = 0; at < line.size();) {
        const std::size_t stop = std::min(line.find_first_of(" \t", at), line.size());
        if (stop > at) bone.dof.push_back(asf_dof(words, line.substr(at, stop - at)));
        at = stop + 1;
      }
      if (bone.dof.size() > 7) words.fail("has too many degrees of freedom", "7 at most");
    } else {
      words.rest_of_line();  // id, limits, bodymass, cofmass
    }
  }
  if (bone.name.empty()) words.fail("a bone has no name", "name");
  bone.offset = length * (direction.norm() > 0.0 ? Eigen::Vector3d(direction.normalized()) : direction);
  return bone;
}

void asf_hierarchy(Words& words, AsfSkeleton& skeleton) {
  words.expect("begin");
  std::vector<bool> placed(skeleton.bones.size(), false);
  placed[0] = true;
  while (!same_word(words.peek(), "end")) {
    const std::string parent_name(words.next("a bone, or end"));
    const int parent = skeleton.find(parent_name);
    if (parent < 0 || !placed[static_cast<std::size_t>(parent)]) {
      words.fail(fmt::format("'{}' has no place yet", shown_word(parent_name)),
                 "root or a bone that an earlier line hangs on it");
    }
    std::string_view line = words.rest_of_line();
    for (std::size_t at = 0; at < line.size();) {
      const std::size_t stop = std::min(line.find_first_of(" \t", at), line.size());
      if (stop > at) {
        const std::string name(line.substr(at, stop - at));
        const int child = skeleton.find(name);
        if (child <= 0 || placed[static_cast<std::size_t>(child)]) {
          words.fail(fmt::format("'{}' is no bone, or hangs elsewhere too", shown_word(name)),
                     "bones of :bonedata, each once");
        }
        skeleton.bones[static_cast<std::size_t>(child)].parent = parent;
        placed[static_cast<std::size_t>(child)] = true;
      }
      at = stop + 1;
    }
  }
  words.expect("end");
  for (std::size_t b = 0; b < placed.size(); ++b) {
    if (!placed[b])
      words.fail(fmt::format("bone '{}' hangs nowhere", shown_word(skeleton.bones[b].name)), "each bone in :hierarchy");
  }
}

AsfSkeleton read_asf(const std::string& file, const std::string& text) {
  AsfSkeleton skeleton;
  skeleton.bones.push_back({"root", -1, Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), {}});
  Words words(file, text);
  bool hierarchy = false;
  while (!words.end()) {
    const std::string_view word = words.next("a section");
    if (same_word(word, ":units")) {
      asf_units(words, skeleton);
    } else if (same_word(word, ":root")) {
      asf_root(words, skeleton);
    } else if (same_word(word, ":bonedata")) {
      while (!asf_section(words)) {
        words.expect("begin");
        expect_bounded_samples(fmt::format("{}:{}", file, words.line()), 1, skeleton.bones.size() + 1);
        skeleton.bones.push_back(asf_bone(words, skeleton.angle_rad));
      }
    } else if (same_word(word, ":hierarchy")) {
      asf_hierarchy(words, skeleton);
      hierarchy = true;
    } else {
      words.rest_of_line();  // comments, :version, :name, :documentation
    }
  }
  if (!hierarchy) words.fail("the file has no :hierarchy", "an ASF skeleton");
  if (skeleton.bones.front().dof.empty()) words.fail("the root has no order", ":root with order TX TY TZ RX RY RZ");
  return skeleton;
}

/// Bones in an order in which each comes after its parent.
std::vector<std::size_t> from_root(const AsfSkeleton& skeleton) {
  std::vector<std::size_t> order = {0};
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t b = 1; b < skeleton.bones.size(); ++b) {
      if (skeleton.bones[b].parent == static_cast<int>(order[i])) order.push_back(b);
    }
  }
  return order;
}

void amc_frame(const AsfSkeleton& skeleton, const std::vector<std::size_t>& order, double angle_rad,
               const std::vector<std::vector<double>>& values, Motion& motion) {
  for (const std::size_t b : order) {
    const Bone& bone = skeleton.bones[b];
    Eigen::Vector3d shift = Eigen::Vector3d::Zero();
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    for (std::size_t d = 0; d < values[b].size(); ++d) {
      const int dof = bone.dof[d];
      if (dof < 3) shift[dof] = values[b][d];
      if (dof >= 3 && dof < 6)
        turn = Eigen::AngleAxisd(angle_rad * values[b][d], Eigen::Vector3d::Unit(dof - 3)) * turn;
    }
    const Eigen::Quaterniond local = bone.axis * turn * bone.axis.conjugate();
    if (bone.parent < 0) {
      motion.points[b].position.push_back(shift);
      motion.points[b].orientation.push_back(local);
    } else {
      const Point& parent = motion.points[static_cast<std::size_t>(bone.parent)];
      const Eigen::Quaterniond global = (parent.orientation.back() * local).normalized();
      motion.points[b].position.push_back(parent.position.back() + global * bone.offset);
      motion.points[b].orientation.push_back(global);
    }
  }
}

}  // namespace

Motion parse_asf_amc(const std::string& asf_file, const std::string& asf, const std::string& amc_file,
                     const std::string& amc) {
  const AsfSkeleton skeleton = read_asf(asf_file, asf);
  const std::vector<std::size_t> order = from_root(skeleton);
  Motion motion;
  motion.format = "ASF/AMC";
  motion.unit_m = 0.0254 / skeleton.length;  // the specification's unit: length of the file's unit in inches, inverted
  motion.unit_name = fmt::format("1/{:g} inch", skeleton.length);
  for (const Bone& bone : skeleton.bones) motion.points.push_back({bone.name, bone.parent, {}, {}});

  Words words(amc_file, amc);
  double angle_rad = skeleton.angle_rad;
  while (!words.end() && (words.peek().front() == '#' || words.peek().front() == ':')) {
    const std::string_view word = words.next("a keyword");
    if (same_word(word, ":DEGREES")) angle_rad = std::numbers::pi / 180.0;
    if (same_word(word, ":RADIANS")) angle_rad = 1.0;
    words.rest_of_line();
  }
  std::vector<std::vector<double>> values(skeleton.bones.size());
  while (!words.end()) {
    const long number = static_cast<long>(motion.frames) + 1;
    words.whole("the number of the next frame", 0, 1L << 40);
    expect_bounded_samples(fmt::format("{}:{}", amc_file, words.line()), motion.frames + 1, motion.points.size());
    for (std::vector<double>& of_bone : values) of_bone.clear();
    double ignored = 0.0;
    while (!words.end() && !to_number(words.peek(), ignored)) {
      const std::string name(words.next("a bone"));
      const int bone = skeleton.find(name);
      if (bone < 0) words.fail(fmt::format("'{}' is no bone of {}", shown_word(name), asf_file), "a bone's name");
      const auto b = static_cast<std::size_t>(bone);
      if (!values[b].empty())
        words.fail(fmt::format("bone '{}' is there twice in frame {}", shown_word(name), number), "it once");
      for (std::size_t d = 0; d < skeleton.bones[b].dof.size(); ++d) {
        values[b].push_back(
            words.number(fmt::format("{} numbers after {}", skeleton.bones[b].dof.size(), shown_word(name))));
      }
    }
    if (values.front().empty()) words.fail(fmt::format("frame {} has no root", number), "a line that begins with root");
    amc_frame(skeleton, order, angle_rad, values, motion);
    ++motion.frames;
  }
  if (motion.frames == 0) words.fail("the file has no frames", "an AMC motion");
  return motion;
}

}  // namespace pmg::mocap
