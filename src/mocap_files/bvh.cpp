#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "mocap_files/motion.hpp"
#include "mocap_files/words.hpp"

namespace pmg::mocap {
namespace {

/// One number of a frame: which axis of which joint, as rotation [deg] or position.
struct BvhChannel {
  std::size_t joint;
  int axis;
  bool rotation;
};

struct BvhSkeleton {
  std::vector<Point> joints;
  std::vector<Eigen::Vector3d> offsets;
  std::vector<BvhChannel> channels;  ///< in the order of a frame's numbers
};

Eigen::Vector3d bvh_vector(Words& words) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = words.number("a number, three of them after OFFSET");
  return v;
}

void bvh_channels(Words& words, std::size_t joint, BvhSkeleton& skeleton) {
  const long count = words.whole("the number of channels", 0, 6);
  for (long i = 0; i < count; ++i) {
    const std::string expected = "a channel: Xposition, Yposition, Zposition, Xrotation, Yrotation or Zrotation";
    const std::string_view word = words.next(expected);
    const int axis = word.empty() ? -1 : (word[0] | 0x20) - 'x';
    const bool rotation = word.size() > 1 && same_word(word.substr(1), "rotation");
    if (axis < 0 || axis > 2 || !(rotation || same_word(word.substr(1), "position"))) {
      words.fail("is an unknown channel", expected);
    }
    skeleton.channels.push_back({joint, axis, rotation});
  }
}

/// The joints from ROOT to its last brace. A joint without any child that has a name ends in "End Site".
BvhSkeleton bvh_hierarchy(const std::string& file, Words& words) {
  BvhSkeleton skeleton;
  std::vector<int> open;  // joints whose brace is open
  words.expect("HIERARCHY");
  do {
    const std::string_view word = words.next("ROOT, JOINT, End, OFFSET, CHANNELS or }");
    const bool end = same_word(word, "End");
    if (same_word(word, "ROOT") || same_word(word, "JOINT") || end) {
      if (same_word(word, "ROOT") != open.empty())
        words.fail("is in the wrong place", "one ROOT, and joints within its braces");
      const int parent = open.empty() ? -1 : open.back();
      std::string name(words.rest_of_line());
      if (!name.empty() && name.back() == '{') {  // the brace on the name's own line
        name = name.substr(0, name.find_last_not_of(" \t{") + 1);
      } else {
        words.expect("{");
      }
      if (end) name = skeleton.joints[static_cast<std::size_t>(parent)].name + ".end";
      if (name.empty()) words.fail("a joint has no name", "a name after ROOT or JOINT");
      expect_bounded_samples(fmt::format("{}:{}", file, words.line()), 1, skeleton.joints.size() + 1);
      open.push_back(static_cast<int>(skeleton.joints.size()));
      skeleton.joints.push_back({name, parent, {}, {}});
      skeleton.offsets.emplace_back(Eigen::Vector3d::Zero());
    } else if (open.empty()) {
      words.fail("the hierarchy has no ROOT", "ROOT");
    } else if (same_word(word, "OFFSET")) {
      skeleton.offsets[static_cast<std::size_t>(open.back())] = bvh_vector(words);
    } else if (same_word(word, "CHANNELS")) {
      bvh_channels(words, static_cast<std::size_t>(open.back()), skeleton);
    } else if (word == "}") {
      open.pop_back();
    } else {
      words.fail(fmt::format("is '{}'", shown_word(word)), "JOINT, End, OFFSET, CHANNELS or }");
    }
  } while (!open.empty());
  return skeleton;
}

/// Positions and orientations of one frame from its numbers.
void bvh_frame(const BvhSkeleton& skeleton, const std::vector<double>& numbers, Motion& motion) {
  std::vector<Eigen::Vector3d> at = skeleton.offsets;
  std::vector<Eigen::Quaterniond> turn(at.size(), Eigen::Quaterniond::Identity());
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    const BvhChannel& channel = skeleton.channels[c];
    if (channel.rotation) {
      const double angle = numbers[c] * std::numbers::pi / 180.0;
      turn[channel.joint] = turn[channel.joint] * Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(channel.axis));
    } else {
      at[channel.joint][channel.axis] = numbers[c];
    }
  }
  for (std::size_t j = 0; j < at.size(); ++j) {
    Point& joint = motion.points[j];
    if (joint.parent >= 0) {
      const Point& parent = motion.points[static_cast<std::size_t>(joint.parent)];
      at[j] = parent.position.back() + parent.orientation.back() * at[j];
      turn[j] = parent.orientation.back() * turn[j];
    }
    joint.position.push_back(at[j]);
    joint.orientation.push_back(turn[j].normalized());
  }
}

}  // namespace

Motion parse_bvh(const std::string& file, const std::string& text) {
  Words words(file, text);
  BvhSkeleton skeleton = bvh_hierarchy(file, words);
  Motion motion;
  motion.format = "BVH";
  if (same_word(words.peek(), "ROOT")) {
    words.next("");
    words.fail("a second ROOT begins", "one skeleton a file; split the file");
  }
  words.expect("MOTION");
  words.expect("Frames:");
  const long frames = words.whole("the number of frames", 1, static_cast<long>(kMostSamples));
  words.expect("Frame");
  words.expect("Time:");
  const double frame_time_s = words.number("the time of a frame in seconds");
  if (frame_time_s < 1e-5 || frame_time_s > 10.0) words.fail("the time of a frame is out of range", "1e-5 to 10 s");
  motion.rate_hz = 1.0 / frame_time_s;
  if (skeleton.channels.empty()) words.fail("the skeleton has no channels", "CHANNELS of its joints");
  expect_bounded_samples(fmt::format("{}:{}", file, words.line() - 1), static_cast<std::size_t>(frames),
                         skeleton.joints.size());
  motion.points = std::move(skeleton.joints);
  std::vector<double> numbers(skeleton.channels.size());
  for (long f = 0; f < frames; ++f) {
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      numbers[c] = words.number(fmt::format("number {} of the {} of frame {}", c + 1, numbers.size(), f + 1));
    }
    bvh_frame(skeleton, numbers, motion);
  }
  if (!words.end()) {
    words.next("");
    words.fail("the file goes on", fmt::format("{} frames of {} numbers and then its end", frames, numbers.size()));
  }
  motion.frames = static_cast<std::size_t>(frames);
  return motion;
}

}  // namespace pmg::mocap
