// Writes MCAP files (mcap.dev/spec) in chunks, compressed by zstd, with an index: Foxglove and the mcap tools seek in
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "topics/message_sink.hpp"

struct ZSTD_CCtx_s;

namespace pmg::logs {

/// Every method throws std::runtime_error if the disk refuses the
/// data.
class McapWriter : public topics::MessageSink {
 public:
  explicit McapWriter(const std::filesystem::path& path);  ///< throws std::runtime_error if the file can't be made

  Id add_schema(std::string_view name, std::string_view encoding, std::string_view data) override;
  Id add_channel(Id schema, std::string_view topic, std::string_view message_encoding,
                 Keep keep = Keep::kEvents) override;  ///< keeps all
  bool wants(Id) const override { return true; }
  void write(Id channel, std::int64_t time_ns, std::string_view data) override;

  /// Writes index and footer, without which the file is incomplete. Call once, at the end.
  void close();

 private:
  /// One record or a sequence of them, as bytes: numbers are little-endian.
  class Bytes {
   public:
    void u8(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
    void u16(std::uint64_t value) { number(value, 2); }
    void u32(std::uint64_t value) { number(value, 4); }
    void u64(std::uint64_t value) { number(value, 8); }
    void text(std::string_view value);  // length, bytes
    void raw(std::string_view value) { bytes_.append(value); }
    void record(std::uint8_t opcode, const Bytes& content);
    const std::string& all() const { return bytes_; }
    std::size_t size() const { return bytes_.size(); }
    void clear() { bytes_.clear(); }

   private:
    void number(std::uint64_t value, int size);
    std::string bytes_;
  };
  struct IndexEntry {
    std::uint64_t time_ns, offset;
  };

  void put(const Bytes& bytes);
  void end_chunk();
  void put_summary();

  std::filesystem::path path_;
  std::ofstream file_;
  std::uint64_t offset_ = 0;  // of the file's end
  Bytes schemas_, channels_;  // for the summary
  Bytes chunk_;
  std::uint64_t chunk_start_ns_ = 0, chunk_end_ns_ = 0;
  std::map<Id, std::vector<IndexEntry>> chunk_index_;
  Bytes chunk_indexes_;  // for the summary
  Id schema_count_ = 0, channel_count_ = 0;
  std::uint32_t chunk_count_ = 0;
  std::map<Id, std::uint64_t> message_counts_;
  std::uint64_t start_ns_ = 0, end_ns_ = 0, message_count_ = 0;
  std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> compressor_;
  std::string compressed_;  // memory is reused
  Bytes content_;           // memory is reused
};

}  // namespace pmg::logs
