#include "logs/mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace pmg::logs {

namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr std::size_t kChunkBytes = 4 << 20;  // of messages: what a reader that seeks must unpack
constexpr const char* kCompression = "zstd";
constexpr int kCompressionLevel = 3;  // zstd's default: higher ones take longer than writing the text

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

std::uint32_t crc32(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

}  // namespace

void McapWriter::Bytes::number(std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes_.push_back(static_cast<char>(value >> (8 * i) & 0xff));
}

void McapWriter::Bytes::text(std::string_view value) {
  u32(value.size());
  raw(value);
}

void McapWriter::Bytes::record(std::uint8_t opcode, const Bytes& content) {
  u8(opcode);
  u64(content.size());
  raw(content.all());
}

McapWriter::McapWriter(const std::filesystem::path& path)
    : path_(path), file_(path, std::ios::binary | std::ios::trunc), compressor_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
  if (!file_) throw std::runtime_error(path.string() + ": can't be created: " + std::strerror(errno));
  Bytes start, header;
  header.text("");     // profile: none
  header.text("pmg");  // library
  start.raw(kMagic);
  start.record(kHeader, header);
  put(start);
}

void McapWriter::put(const Bytes& bytes) {
  file_.write(bytes.all().data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw std::runtime_error(path_.string() + ": can't be written (disk full?)");
  offset_ += bytes.size();
}

McapWriter::Id McapWriter::add_schema(std::string_view name, std::string_view encoding, std::string_view data) {
  Bytes schema;
  schema.u16(++schema_count_);  // 0 means no schema
  schema.text(name);
  schema.text(encoding);
  schema.text(data);
  schemas_.record(kSchema, schema);
  chunk_.record(kSchema, schema);
  return schema_count_;
}

McapWriter::Id McapWriter::add_channel(Id schema, std::string_view topic, std::string_view message_encoding, Keep) {
  Bytes channel;
  channel.u16(++channel_count_);
  channel.u16(schema);
  channel.text(topic);
  channel.text(message_encoding);
  channel.u32(0);  // no metadata
  channels_.record(kChannel, channel);
  chunk_.record(kChannel, channel);
  message_counts_[channel_count_] = 0;
  return channel_count_;
}

void McapWriter::write(Id channel, std::int64_t time_ns, std::string_view data) {
  const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(time_ns, 0));
  chunk_start_ns_ = chunk_index_.empty() ? time : std::min(chunk_start_ns_, time);
  chunk_end_ns_ = chunk_index_.empty() ? time : std::max(chunk_end_ns_, time);
  chunk_index_[channel].push_back({time, chunk_.size()});

  content_.clear();
  content_.u16(channel);
  content_.u32(message_counts_[channel]++);  // sequence
  content_.u64(time);                        // logged
  content_.u64(time);                        // published
  content_.raw(data);
  chunk_.record(kMessage, content_);
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.size() == 0) return;
  compressed_.resize(ZSTD_compressBound(chunk_.size()));
  const std::size_t compressed_size = ZSTD_compressCCtx(compressor_.get(), compressed_.data(), compressed_.size(),
                                                        chunk_.all().data(), chunk_.size(), kCompressionLevel);
  if (ZSTD_isError(compressed_size) != 0) throw std::runtime_error(path_.string() + ": can't be compressed");
  compressed_.resize(compressed_size);
  Bytes chunk, out;
  chunk.u64(chunk_start_ns_);
  chunk.u64(chunk_end_ns_);
  chunk.u64(chunk_.size());
  chunk.u32(crc32(chunk_.all()));
  chunk.text(kCompression);
  chunk.u64(compressed_.size());
  chunk.raw(compressed_);
  out.record(kChunk, chunk);
  const std::uint64_t chunk_offset = offset_, chunk_length = out.size();

  Bytes index_offsets;
  for (const auto& [channel, entries] : chunk_index_) {
    index_offsets.u16(channel);
    index_offsets.u64(chunk_offset + out.size());
    Bytes index;
    index.u16(channel);
    index.u32(16 * entries.size());
    for (const IndexEntry& entry : entries) {
      index.u64(entry.time_ns);
      index.u64(entry.offset);
    }
    out.record(kMessageIndex, index);
  }

  Bytes chunk_index;
  chunk_index.u64(chunk_start_ns_);
  chunk_index.u64(chunk_end_ns_);
  chunk_index.u64(chunk_offset);
  chunk_index.u64(chunk_length);
  chunk_index.text(index_offsets.all());
  chunk_index.u64(out.size() - chunk_length);
  chunk_index.text(kCompression);
  chunk_index.u64(compressed_.size());
  chunk_index.u64(chunk_.size());
  chunk_indexes_.record(kChunkIndex, chunk_index);
  put(out);

  if (!chunk_index_.empty()) {
    start_ns_ = message_count_ == 0 ? chunk_start_ns_ : std::min(start_ns_, chunk_start_ns_);
    end_ns_ = std::max(end_ns_, chunk_end_ns_);
  }
  for (const auto& [channel, entries] : chunk_index_) message_count_ += entries.size();
  ++chunk_count_;
  chunk_.clear();
  chunk_index_.clear();
  chunk_start_ns_ = chunk_end_ns_ = 0;
}

void McapWriter::close() {
  end_chunk();
  Bytes end, data_end;
  data_end.u32(0);  // no CRC over the whole: each chunk has its own
  end.record(kDataEnd, data_end);
  put(end);
  put_summary();
  file_.flush();
  if (!file_) throw std::runtime_error(path_.string() + ": can't be written (disk full?)");
}

void McapWriter::put_summary() {
  Bytes counts, statistics, statistics_record;
  for (const auto& [channel, count] : message_counts_) {
    counts.u16(channel);
    counts.u64(count);
  }
  statistics.u64(message_count_);
  statistics.u16(schema_count_);
  statistics.u32(channel_count_);
  statistics.u32(0);  // attachments
  statistics.u32(0);  // metadata
  statistics.u32(chunk_count_);
  statistics.u64(start_ns_);
  statistics.u64(end_ns_);
  statistics.text(counts.all());
  statistics_record.record(kStatistics, statistics);

  const std::uint64_t summary_start = offset_;
  Bytes summary, offsets;
  const auto group = [&](Opcode opcode, const Bytes& records) {
    if (records.size() == 0) return;
    Bytes offset;
    offset.u8(opcode);
    offset.u64(summary_start + summary.size());
    offset.u64(records.size());
    offsets.record(kSummaryOffset, offset);
    summary.raw(records.all());
  };
  group(kSchema, schemas_);
  group(kChannel, channels_);
  group(kStatistics, statistics_record);
  group(kChunkIndex, chunk_indexes_);
  const std::uint64_t offsets_start = summary_start + summary.size();
  summary.raw(offsets.all());

  // The CRC covers the summary and the footer up to the CRC itself.
  summary.u8(kFooter);
  summary.u64(20);
  summary.u64(summary_start);
  summary.u64(offsets_start);
  summary.u32(crc32(summary.all()));
  summary.raw(kMagic);
  put(summary);
}

}  // namespace pmg::logs
