// A motion as its file has it: points with names, in the file's own unit and axes.
#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pmg::mocap {

/// The largest motion file that is read [bytes], and the most point samples of one motion: 100 points for 14 minutes at
/// 120 Hz. A longer recording has to be cut first.
inline constexpr std::uint64_t kLargestMotion_bytes = 256U << 20;
inline constexpr std::size_t kMostSamples = 10'000'000, kMostPoints = 1000;

/// A joint of a skeleton, or a marker.
struct Point {
  std::string name;
  int parent = -1;                              ///< index of the parent joint; -1: root, or a marker
  std::vector<Eigen::Vector3d> position;        ///< of each frame [the file's unit]; NaN where a marker was not seen
  std::vector<Eigen::Quaterniond> orientation;  ///< of each frame, file axes; empty for markers
};

struct Motion {
  std::string format;  ///< "BVH", "ASF/AMC", "TRC", "C3D", "AMASS", "robot CSV"
  bool markers = false;
  std::optional<double> rate_hz, unit_m;  ///< as the file states them
  std::string unit_name;                  ///< the file's word for it
  std::size_t frames = 0;
  std::vector<Point> points;
  std::vector<std::string> joints;             ///< of a robot, or parameters of a body model
  std::vector<std::vector<double>> joint_rad;  ///< of each frame, in the order of joints
  std::vector<std::string> notes;              ///< what a user should know about how the file was read
};

/// What a file lacks and its user knows.
struct ReadOptions {
  std::filesystem::path skeleton;   ///< ASF file of an AMC file
  std::filesystem::path rest_pose;  ///< CSV of a body model's joints at rest: joint,x_m,y_m,z_m
};

/// Reads by the file's ending: .bvh, .amc, .trc, .c3d, .npz, .csv. Throws ConfigError with file, line or byte, and what
/// was expected.
Motion read_motion(const std::filesystem::path& file, const ReadOptions& options = {});

// The readers, from a file's whole content. file: its name, for errors. All throw ConfigError.

/// Biovision hierarchy: any skeleton, any channel order. A joint's position channels replace its offset.
Motion parse_bvh(const std::string& file, const std::string& text);
/// Acclaim skeleton and motion (asf, amc), with the conventions of their specification: a bone's global rotation is its
/// parent's times C M C^-1, C from `axis`, M from the degrees of freedom.
Motion parse_asf_amc(const std::string& asf_file, const std::string& asf, const std::string& amc_file,
                     const std::string& amc);
/// Track Row Column: markers, tab separated (Motion Analysis).
Motion parse_trc(const std::string& file, const std::string& text);
/// C3D, https://www.c3d.org/HTML: markers; Intel, DEC and MIPS numbers, scaled integers and floats.
Motion parse_c3d(const std::string& file, const std::string& bytes);
/// SMPL parameters in AMASS's npz: poses (axis-angle of each joint), trans, frame rate. rest_pose: text of the rest
/// pose file; without it (empty) the result has the root alone, and the other joints' parameters as joint_rad.
Motion parse_amass(const std::string& file, const std::string& bytes, const std::string& rest_pose_file,
                   const std::string& rest_pose);
/// A robot's root pose and joint angles, one frame a row [m, quaternion, rad]. Columns by name, or without a header
/// x, y, z, quaternion, joints.
Motion parse_robot_csv(const std::string& file, const std::string& text);

/// Throws ConfigError if so many frames of so many points are more than kMostSamples. place: the file, or FILE:LINE.
void expect_bounded_samples(const std::string& place, std::size_t frames, std::size_t points);

}  // namespace pmg::mocap
