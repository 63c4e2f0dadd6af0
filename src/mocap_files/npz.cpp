#include "mocap_files/npz.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <charconv>

#include "mocap_files/bytes.hpp"
#include "mocap_files/motion.hpp"
#include "mocap_files/words.hpp"

namespace pmg::mocap {
namespace {

/// A zip entry's place, from the central directory.
struct ZipEntry {
  std::string name;
  std::size_t method = 0, packed = 0, unpacked = 0, header_at = 0, directory_at = 0;
  std::uint32_t crc = 0;
};

std::vector<ZipEntry> zip_directory(const Bytes& bytes) {
  constexpr std::size_t kEnd_bytes = 22, kLongestComment_bytes = 65535;
  if (bytes.size() < kEnd_bytes) bytes.fail(0, "is too short for a zip file", "NumPy's npz");
  std::size_t end = bytes.size() - kEnd_bytes;
  const std::size_t stop = end > kLongestComment_bytes ? end - kLongestComment_bytes : 0;
  while (bytes.u32(end, "") != 0x06054b50 && end > stop) --end;
  if (bytes.u32(end, "") != 0x06054b50) bytes.fail(bytes.size() - kEnd_bytes, "is no end of a zip file", "NumPy's npz");
  const std::size_t count = bytes.u16(end + 10, "the number of entries");
  std::size_t at = bytes.u32(end + 16, "the directory's place");
  std::vector<ZipEntry> entries;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string expected = "an entry of the zip directory";
    if (bytes.u32(at, expected) != 0x02014b50) bytes.fail(at, "is no zip entry", expected);
    ZipEntry entry;
    entry.directory_at = at;
    entry.method = bytes.u16(at + 10, expected);
    entry.crc = bytes.u32(at + 16, expected);
    entry.packed = bytes.u32(at + 20, expected);
    entry.unpacked = bytes.u32(at + 24, expected);
    const std::size_t name = bytes.u16(at + 28, expected);
    entry.header_at = bytes.u32(at + 42, expected);
    entry.name = bytes.at(at + 46, name, expected);
    at += 46 + name + bytes.u16(at + 30, expected) + bytes.u16(at + 32, expected);
    entries.push_back(entry);
  }
  return entries;
}

/// The entry's content, its checksum verified.
std::string zip_content(const Bytes& bytes, const ZipEntry& entry) {
  const std::string expected = fmt::format("the content of an array");
  if (bytes.u32(entry.header_at, expected) != 0x04034b50) bytes.fail(entry.header_at, "is no zip entry", expected);
  if (entry.unpacked > kLargestMotion_bytes) {
    bytes.fail(entry.directory_at, fmt::format("the array has {} bytes", entry.unpacked),
               fmt::format("{} at most", kLargestMotion_bytes));
  }
  const std::size_t data =
      entry.header_at + 30 + bytes.u16(entry.header_at + 26, expected) + bytes.u16(entry.header_at + 28, expected);
  const std::string_view packed = bytes.at(data, entry.packed, expected);
  std::string content;
  if (entry.method == 0) {
    content = packed;
  } else if (entry.method == 8) {
    // Deflate reaches 1032:1 at best, so a larger promise is a broken file and takes no memory.
    if (entry.unpacked / 1032 > entry.packed)
      bytes.fail(entry.directory_at, "promises more than deflate can hold", "an npz file");
    content.resize(entry.unpacked);
    z_stream stream{};
    stream.next_in = reinterpret_cast<const Bytef*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(content.data());
    stream.avail_out = static_cast<uInt>(content.size());
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) bytes.fail(data, "cannot be inflated", "memory for zlib");
    const int result = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    if (result != Z_STREAM_END || stream.avail_out != 0) bytes.fail(data, "is damaged deflated data", expected);
  } else {
    bytes.fail(entry.directory_at, fmt::format("is packed by method {}", entry.method),
               "stored or deflated entries, as NumPy writes them");
  }
  const uLong crc = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  if (content.size() != entry.unpacked || crc != entry.crc) bytes.fail(data, "does not fit its checksum", expected);
  return content;
}

/// What stands behind a key of the header, a Python dictionary.
std::string_view npy_value(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  const std::size_t colon = header.find(':', at);
  return colon == std::string_view::npos ? std::string_view() : header.substr(colon + 1);
}

double npy_number(const Bytes& bytes, std::size_t at, char kind, std::size_t width) {
  std::uint64_t raw = bytes.u32(at, "a number") & (width == 1 ? 0xffU : width == 2 ? 0xffffU : 0xffffffffU);
  if (width == 8) raw |= static_cast<std::uint64_t>(bytes.u32(at + 4, "a number")) << 32;
  if (kind == 'f')
    return width == 8 ? std::bit_cast<double>(raw)
                      : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
  if (kind == 'u') return static_cast<double>(raw);
  return width == 8 ? static_cast<double>(static_cast<std::int64_t>(raw))
                    : static_cast<double>(static_cast<std::int32_t>(raw));
}

NpyArray parse_npy(const std::string& name, const std::string& content) {
  const Bytes bytes(name, content);
  if (bytes.at(0, 6, "NumPy's mark") != std::string_view("\x93NUMPY", 6))
    bytes.fail(0, "is no npy array", "NumPy's mark");
  const bool long_header = bytes.u8(6, "the version") >= 2;
  const std::size_t length = long_header ? bytes.u32(8, "the header's length") : bytes.u16(8, "the header's length");
  const std::size_t start = long_header ? 12 : 10;
  const std::string_view header = bytes.at(start, length, "the array's header");
  NpyArray array;
  std::string_view shape = npy_value(header, "'shape'");
  if (shape.find('(') == std::string_view::npos || shape.find(')') == std::string_view::npos)
    bytes.fail(start, "has no shape", "'shape': (...)");
  shape = shape.substr(shape.find('(') + 1);
  shape = shape.substr(0, shape.find(')'));
  std::size_t count = 1;
  for (const char* at = shape.data(); at < shape.data() + shape.size();) {
    std::size_t extent = 0;
    const auto [end, error] = std::from_chars(at, shape.data() + shape.size(), extent);
    if (error == std::errc()) {
      if (extent > kLargestMotion_bytes || count * std::max<std::size_t>(extent, 1) > kLargestMotion_bytes)
        bytes.fail(start, "has too many numbers", "a smaller array");
      array.shape.push_back(extent);
      count *= extent;
    }
    at = error == std::errc() ? end : at + 1;
  }
  const std::string_view type = npy_value(header, "'descr'");
  const std::size_t quote = type.find('\'');
  if (quote == std::string_view::npos || quote + 3 >= type.size()) return array;  // a structure
  const char order = type[quote + 1], kind = type[quote + 2];
  const std::size_t width = static_cast<std::size_t>(type[quote + 3] - '0');
  const bool numbers =
      (kind == 'f' && (width == 4 || width == 8)) || ((kind == 'i' || kind == 'u') && (width == 4 || width == 8));
  if (!numbers || quote + 4 >= type.size() || type[quote + 4] != '\'') return array;
  if (order == '>') bytes.fail(start, "has big-endian numbers", "little-endian ones");
  if (npy_value(header, "'fortran_order'").substr(0, 6).find("True") != std::string_view::npos &&
      array.shape.size() > 1) {
    bytes.fail(start, "is stored column by column", "an array in C order: numpy.ascontiguousarray");
  }
  bytes.at(start + length, count * width, fmt::format("{} numbers", count));
  array.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) array.values[i] = npy_number(bytes, start + length + i * width, kind, width);
  return array;
}

}  // namespace

std::map<std::string, NpyArray> parse_npz(const std::string& file, const std::string& content) {
  const Bytes bytes(file, content);
  std::map<std::string, NpyArray> arrays;
  std::size_t total = 0;
  for (const ZipEntry& entry : zip_directory(bytes)) {
    if (!entry.name.ends_with(".npy")) continue;
    total += entry.unpacked;
    if (total > kLargestMotion_bytes)
      bytes.fail(entry.directory_at, "the arrays together are too large",
                 fmt::format("{} bytes at most", kLargestMotion_bytes));
    const std::string name = entry.name.substr(0, entry.name.size() - 4);
    arrays[name] = parse_npy(file + ": array '" + shown_word(name) + "'", zip_content(bytes, entry));
  }
  return arrays;
}

}  // namespace pmg::mocap
