// Small made-up motion files of every format, whose content is known.
#pragma once

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace pmg::mocap::test {

/// A hip that stands at 100, a thigh of 40 and a shank of 45 [cm, y up]; in frame 2 the thigh points forward (z).
inline std::string small_bvh() {
  return "HIERARCHY\nROOT Hips\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation "
         "Xrotation\n"
         " JOINT LeftUpLeg\n {\n  OFFSET 10 0 0\n  CHANNELS 3 Zrotation Yrotation Xrotation\n"
         "  JOINT LeftLeg\n  {\n   OFFSET 0 -40 0\n   CHANNELS 3 Zrotation Yrotation Xrotation\n"
         "   JOINT LeftFoot\n   {\n    OFFSET 0 -45 0\n    CHANNELS 3 Zrotation Yrotation Xrotation\n"
         "    End Site\n    {\n     OFFSET 0 -5 15\n    }\n   }\n  }\n }\n}\n"
         "MOTION\nFrames: 2\nFrame Time: 0.01\n"
         "0 100 0 0 0 0  0 0 0  0 0 0  0 0 0\n"
         "1 100 2 0 0 0  0 0 -90  0 0 0  0 0 0\n";
}

/// A root and a thigh of 2 units along -y, its axes turned by 20 degrees about z; frame 2 turns it about its own x.
inline std::string small_asf() {
  return "# made up\n:version 1.10\n:name x\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n:root\n  order TX TY TZ "
         "RX RY RZ\n  axis XYZ\n"
         "  position 0 0 0\n  orientation 0 0 0\n:bonedata\n  begin\n    id 1\n    name lfemur\n    direction 0 -1 0\n "
         "   length 2\n"
         "    axis 0 0 20 XYZ\n    dof rx ry rz\n    limits (-160 20)\n           (-70 70)\n           (-60 70)\n  "
         "end\n"
         ":hierarchy\n  begin\n    root lfemur\n  end\n";
}
inline std::string small_amc() {
  return "#!OML:ASF\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 0 0\nlfemur 0 0 0\n2\nroot 1 2 3 0 90 0\nlfemur -90 0 "
         "0\n";
}

inline std::string small_trc() {
  return "PathFileType\t4\t(X/Y/"
         "Z)\tx."
         "trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
         "100\t100\t3\t2\tmm\t100\t1\t3\nFrame#\tTime\tL.Heel\t\t\tL.Toe\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n"
         "1\t0.00\t1\t2\t3\t4\t5\t6\n2\t0.01\t\t\t\t4.5\t5\t6\n3\t0.02\t3\t2\t3\t5\t5\t6\n";
}

inline std::string robot_csv() {
  return "root_x,root_y,root_z,root_qx,root_qy,root_qz,root_qw,left_knee,right_knee\n0,0,0.8,0,0,0,1,0.1,0.2\n0.01,0,0."
         "8,0,0,0.7071068,0.7071068,0.3,0.4\n";
}

enum class C3dProcessor : std::uint8_t { kIntel = 84, kDec = 85, kMips = 86 };

/// Bytes of a C3D file as each processor writes them.
class C3dWriter {
 public:
  explicit C3dWriter(C3dProcessor processor) : processor_(processor) {}
  void byte(int value) { bytes_ += static_cast<char>(value); }
  void word(int value) {
    const bool high_first = processor_ == C3dProcessor::kMips;
    byte((high_first ? value >> 8 : value) & 0xff);
    byte((high_first ? value : value >> 8) & 0xff);
  }
  void real(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(processor_ == C3dProcessor::kDec ? value * 4.0F : value);
    const int low = static_cast<int>(bits & 0xffff), high = static_cast<int>(bits >> 16);
    const bool low_first = processor_ == C3dProcessor::kIntel;
    word(low_first ? low : high);
    word(low_first ? high : low);
  }
  void text(const std::string& value) { bytes_ += value; }
  void fill_block() { bytes_.resize((bytes_.size() + 511) / 512 * 512, '\0'); }
  std::string& bytes() { return bytes_; }

 private:
  C3dProcessor processor_;
  std::string bytes_;
};

/// Two markers, LHEE and LTOE, over 3 frames at 50 Hz in mm: marker m of frame f is at (f, 10 m, 100), but LTOE is not
/// seen in frame 1. scale below 0: floats, else integers of this many mm.
inline std::string small_c3d(C3dProcessor processor, float scale) {
  C3dWriter file(processor);
  file.byte(2);
  file.byte(0x50);
  for (const int value : {2, 0, 1, 3, 0}) file.word(value);  // points, analog, first and last frame, gap
  file.real(scale);
  file.word(3);  // first data block
  file.word(0);
  file.real(50.0F);
  file.fill_block();
  for (const int value : {1, 0x50, 1, static_cast<int>(processor)}) file.byte(value);
  file.byte(5), file.byte(-1), file.text("POINT"), file.word(3), file.byte(0);
  file.byte(6), file.byte(1), file.text("LABELS"), file.word(2 + 1 + 1 + 2 + 8 + 1), file.byte(-1), file.byte(2),
      file.byte(4), file.byte(2), file.text("LHEELTOE"), file.byte(0);
  file.byte(5), file.byte(1), file.text("UNITS"), file.word(0), file.byte(-1), file.byte(1), file.byte(2),
      file.text("mm"), file.byte(0);
  file.fill_block();
  for (int f = 0; f < 3; ++f) {
    for (int m = 0; m < 2; ++m) {
      const bool seen = !(m == 1 && f == 1);
      const float x = static_cast<float>(f), y = 10.0F * static_cast<float>(m);
      if (scale < 0.0F) {
        for (const float value : {x, y, 100.0F, seen ? 0.0F : -1.0F}) file.real(value);
      } else {
        for (const float value : {x, y, 100.0F}) file.word(static_cast<int>(value / scale));
        file.word(seen ? 0 : -1);
      }
    }
  }
  file.fill_block();
  return file.bytes();
}

inline std::string npy(const std::string& type, const std::string& shape, const std::string& data) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize((header.size() + 10 + 63) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += '\x01';
  bytes += '\0';
  bytes += static_cast<char>(header.size() & 0xff);
  bytes += static_cast<char>(header.size() >> 8);
  return bytes + header + data;
}

template <typename T>
std::string raw(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string little(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i) & 0xff);
  return text;
}

/// A zip of these files, deflated or stored.
inline std::string zip(const std::vector<std::pair<std::string, std::string>>& files, bool deflated) {
  std::string bytes, directory;
  for (const auto& [name, content] : files) {
    std::string packed = content, input = content;
    if (deflated) {
      packed.resize(compressBound(static_cast<uLong>(content.size())) + 64);
      z_stream stream{};
      deflateInit2(&stream, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
      stream.next_in = reinterpret_cast<Bytef*>(input.data());
      stream.avail_in = static_cast<uInt>(content.size());
      stream.next_out = reinterpret_cast<Bytef*>(packed.data());
      stream.avail_out = static_cast<uInt>(packed.size());
      deflate(&stream, Z_FINISH);
      packed.resize(stream.total_out);
      deflateEnd(&stream);
    }
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
    const std::string common = little(20, 2) + little(0, 2) + little(deflated ? 8 : 0, 2) + little(0, 4) +
                               little(crc, 4) + little(static_cast<std::uint32_t>(packed.size()), 4) +
                               little(static_cast<std::uint32_t>(content.size()), 4) +
                               little(static_cast<std::uint32_t>(name.size()), 2) + little(0, 2);
    directory.append("PK\x01\x02").append(little(20, 2)).append(common);
    directory.append(little(0, 2)).append(little(0, 2)).append(little(0, 2)).append(little(0, 4));
    directory.append(little(static_cast<std::uint32_t>(bytes.size()), 4)).append(name);
    bytes.append("PK\x03\x04").append(common).append(name).append(packed);
  }
  const auto count = static_cast<std::uint32_t>(files.size());
  return bytes + directory + "PK\x05\x06" + little(0, 4) + little(count, 2) + little(count, 2) +
         little(static_cast<std::uint32_t>(directory.size()), 4) + little(static_cast<std::uint32_t>(bytes.size()), 4) +
         little(0, 2);
}

/// Two frames of an SMPL body: upright, then its left hip turned by 90 degrees about x, moved 1 m along y.
inline std::string small_npz(bool deflated) {
  std::vector<double> poses(2 * 66, 0.0);
  poses[66 + 3] = -1.5707963267948966;
  return zip({{"poses.npy", npy("<f8", "(2, 66)", raw(poses))},
              {"trans.npy", npy("<f4", "(2, 3)", raw(std::vector<float>{0, 0, 0, 0, 1, 0}))},
              {"gender.npy", npy("<U4", "()", std::string(16, 'm'))},
              {"mocap_framerate.npy", npy("<f8", "()", raw(std::vector<double>{60.0}))}},
             deflated);
}

/// Joints of a made-up body [m], y up as SMPL's templates are: legs of 0.4 and 0.4.
inline std::string small_rest_pose() {
  return "joint,x,y,z\npelvis,0,0,0\nleft_hip,0.1,0,0\nright_hip,-0.1,0,0\nspine1,0,0.1,0\nleft_knee,0.1,-0.4,0\nright_"
         "knee,-0.1,-0.4,0\n"
         "spine2,0,0.2,0\nleft_ankle,0.1,-0.8,0\nright_ankle,-0.1,-0.8,0\nspine3,0,0.3,0\nleft_foot,0.1,-0.85,0."
         "1\nright_foot,-0.1,-0.85,0.1\n"
         "neck,0,0.5,0\nleft_collar,0.05,0.45,0\nright_collar,-0.05,0.45,0\nhead,0,0.6,0\nleft_shoulder,0.2,0.45,"
         "0\nright_shoulder,-0.2,0.45,0\n"
         "left_elbow,0.5,0.45,0\nright_elbow,-0.5,0.45,0\nleft_wrist,0.75,0.45,0\nright_wrist,-0.75,0.45,0\n";
}

}  // namespace pmg::mocap::test
