#include "chunked_container.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "traverse/files/binary_file.hpp"
#include "traverse/files/input_error.hpp"

#include "lazy_library.hpp"

namespace traverse::bags {

namespace {
constexpr const char* kCut = "the file is cut short: the rest of the chunk is lost";
}

struct ChunkedContainer::Here : Position {
  std::vector<bool> wanted;
  std::size_t next_chunk = 0;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> waiting;
  std::map<std::size_t, std::size_t> left;
};

bool ChunkedContainer::Entry::operator>(const Entry& other) const {
  return std::tie(message.log_time_ns, chunk, message.offset) >
         std::tie(other.message.log_time_ns, other.chunk, other.message.offset);
}

std::string ChunkedContainer::place_of(const Chunk& chunk) {
  return fmt::format("chunk at byte {}", chunk.position);
}

void ChunkedContainer::finish_opening(const std::string& kind) {
  std::stable_sort(chunks_.begin(), chunks_.end(), [](const Chunk& a, const Chunk& b) {
    return std::tie(a.first_ns, a.position) < std::tie(b.first_ns, b.position);
  });
  is_told_.assign(chunks_.size(), false);
  for (const Channel& channel : contents_.channels) contents_.messages += channel.count;
  if (!chunks_.empty()) {
    contents_.first_ns = chunks_.front().first_ns;
    for (const Chunk& chunk : chunks_) {
      contents_.last_ns = std::max(contents_.last_ns, chunk.last_ns);
    }
  }
  if (contents_.channels.empty()) {
    std::string found = "none";
    for (const auto& [reason, loss] : losses_.by_reason()) {
      found += fmt::format("; {} x {} ({})", loss.count, reason, loss.first_places.front());
    }
    throw files::InputError(file_.path(), files::Place::whole_file(),
                            kind + " with messages of a topic", found);
  }
}

std::string ChunkedContainer::load(const Chunk& chunk, std::vector<std::byte>& bytes) {
  bytes.clear();
  if (std::max(chunk.packed, chunk.unpacked) > files::kMostBytesAtOnce) {
    return fmt::format("a chunk of {} bytes: at most {} are read at once",
                       std::max(chunk.packed, chunk.unpacked), files::kMostBytesAtOnce);
  }
  try {
    if (chunk.packing == Packing::kNone) {
      file_.read(chunk.position, chunk.packed, bytes);
      return bytes.size() < std::max(chunk.packed, chunk.unpacked) ? kCut : "";
    }
    file_.read(chunk.position, chunk.packed, packed_);
    const std::string fault = unpack(chunk.packing, packed_, chunk.unpacked, bytes);
    return packed_.size() < chunk.packed ? kCut : fault;
  } catch (const NoLibrary& error) {
    throw files::InputError(file_.path(), files::Place{place_of(chunk)},
                            fmt::format("{} to unpack it with", name_of(chunk.packing)),
                            error.what());
  }
}

std::uint32_t ChunkedContainer::index_of(Channel channel) {
  const auto same =
      std::find_if(contents_.channels.begin(), contents_.channels.end(), [&](const Channel& other) {
        return other.topic == channel.topic && other.type == channel.type &&
               other.encoding == channel.encoding && other.definition == channel.definition;
      });
  const auto index = static_cast<std::uint32_t>(same - contents_.channels.begin());
  if (same == contents_.channels.end()) contents_.channels.push_back(std::move(channel));
  return index;
}

void ChunkedContainer::look_into(Chunk chunk) {
  std::vector<std::byte> bytes;
  std::string fault = load(chunk, bytes);
  find_channels(bytes);
  std::vector<Found> messages;
  const std::string broken = find_messages(bytes, messages);
  if (fault.empty()) fault = broken;
  std::set<std::uint32_t> channels;
  chunk.first_ns = std::numeric_limits<std::int64_t>::max();
  chunk.last_ns = std::numeric_limits<std::int64_t>::min();
  for (const Found& message : messages) {
    if (message.channel == kUndescribed) continue;
    chunk.first_ns = std::min(chunk.first_ns, message.log_time_ns);
    chunk.last_ns = std::max(chunk.last_ns, message.log_time_ns);
    channels.insert(message.channel);
    ++contents_.channels[message.channel].count;
  }
  if (channels.empty()) {  // it will not be read again, which would tell
    if (!fault.empty()) losses_.add(fault, place_of(chunk));
    tell_undescribed(messages, chunk);
    return;
  }
  chunk.channels.assign(channels.begin(), channels.end());
  chunks_.push_back(std::move(chunk));
}

void ChunkedContainer::tell_undescribed(const std::vector<Found>& messages, const Chunk& chunk) {
  for (const Found& message : messages) {
    if (message.channel != kUndescribed) continue;
    losses_.add("message of a channel that the file does not describe", place_of(chunk));
  }
}

std::string ChunkedContainer::packings() const {
  std::set<std::string_view> names;
  for (const Chunk& chunk : chunks_) names.insert(name_of(chunk.packing));
  std::string text;
  for (const std::string_view name : names) {
    text += (text.empty() ? "" : ", ") + std::string(name);
  }
  return text.empty() ? "none" : text;
}

bool ChunkedContainer::has_wanted(const Chunk& chunk) const {
  return chunk.channels.empty() ||
         std::any_of(chunk.channels.begin(), chunk.channels.end(), [&](std::uint32_t channel) {
           return channel < wanted_.size() && wanted_[channel];
         });
}

void ChunkedContainer::begin(const std::vector<std::size_t>& channels) {
  wanted_.assign(contents_.channels.size(), false);
  for (const std::size_t channel : channels) wanted_.at(channel) = true;
  next_chunk_ = 0;
  waiting_ = {};
  left_.clear();
}

/// Gives memory back: of a recording in many files those behind are not read again.
void ChunkedContainer::release() {
  cached_.clear();
  spare_.clear();
  packed_ = {};
  found_ = {};
}

void ChunkedContainer::make_room(std::uint64_t bytes) {
  const auto recycle = [&](std::vector<Cached>::iterator at) {
    spare_.push_back(std::move(at->bytes));
    cached_.erase(at);
  };
  for (auto at = cached_.begin(); at != cached_.end();) {
    const bool is_of_head = at->chunk < kHeadChunks && next_chunk_ < 2 * kHeadChunks;
    if (is_of_head || left_.count(at->chunk) > 0) {
      ++at;
      continue;
    }
    const auto index = at - cached_.begin();
    recycle(at);
    at = cached_.begin() + index;
  }
  for (;;) {
    std::uint64_t kept = bytes;
    for (const Cached& other : cached_) kept += other.bytes.capacity();
    if (kept <= kMostCached || cached_.empty()) break;
    recycle(std::min_element(cached_.begin(), cached_.end(), [](const Cached& a, const Cached& b) {
      return a.last_used < b.last_used;
    }));
  }
  while (spare_.size() > 1) {  // the largest is enough
    const auto smaller =
        spare_[0].capacity() < spare_[1].capacity() ? spare_.begin() : spare_.begin() + 1;
    spare_.erase(smaller);
  }
}

ChunkedContainer::Cached& ChunkedContainer::cache(std::size_t chunk) {
  const auto known = std::find_if(cached_.begin(), cached_.end(),
                                  [&](const Cached& other) { return other.chunk == chunk; });
  if (known != cached_.end()) {
    known->last_used = ++uses_;
    return *known;
  }
  make_room(std::min<std::uint64_t>(chunks_[chunk].unpacked, kMostCached));
  Cached fresh{chunk, ++uses_, {}};
  if (!spare_.empty()) {
    fresh.bytes = std::move(spare_.back());
    spare_.pop_back();
  }
  const std::string fault = load(chunks_[chunk], fresh.bytes);
  if (!fault.empty() && !is_told_[chunk]) losses_.add(fault, place_of(chunks_[chunk]));
  if (!fault.empty()) is_told_[chunk] = true;
  cached_.push_back(std::move(fresh));
  return cached_.back();
}

void ChunkedContainer::take_chunk(std::size_t chunk) {
  found_.clear();
  const bool is_first_time = !is_told_[chunk];
  const std::vector<std::byte>& bytes = cache(chunk).bytes;
  const std::string fault = find_messages(bytes, found_);
  if (!fault.empty() && !is_told_[chunk]) losses_.add(fault, place_of(chunks_[chunk]));
  if (is_first_time) tell_undescribed(found_, chunks_[chunk]);
  is_told_[chunk] = true;
  for (const Found& message : found_) {
    if (message.channel >= wanted_.size() || !wanted_[message.channel]) continue;
    waiting_.push({message, chunk});
    ++left_[chunk];
  }
}

std::optional<Message> ChunkedContainer::next() {
  while (next_chunk_ < chunks_.size()) {
    const Chunk& chunk = chunks_[next_chunk_];
    if (!waiting_.empty() && waiting_.top().message.log_time_ns < chunk.first_ns) break;
    if (has_wanted(chunk)) take_chunk(next_chunk_);
    ++next_chunk_;
  }
  if (waiting_.empty()) {
    release();
    return std::nullopt;
  }
  const Entry entry = waiting_.top();
  waiting_.pop();
  const Cached& chunk = cache(entry.chunk);
  if (--left_[entry.chunk] == 0) left_.erase(entry.chunk);
  // What was there when it was found may be gone when it is unpacked again: a file that changes.
  if (entry.message.offset + entry.message.size > chunk.bytes.size()) return next();
  return Message{entry.message.channel, entry.message.log_time_ns,
                 std::span(chunk.bytes).subspan(entry.message.offset, entry.message.size)};
}

double ChunkedContainer::share_read() const {
  return chunks_.empty() ? 1
                         : static_cast<double>(next_chunk_) / static_cast<double>(chunks_.size());
}

std::shared_ptr<const Position> ChunkedContainer::position() const {
  auto here = std::make_shared<Here>();
  here->wanted = wanted_;
  here->next_chunk = next_chunk_;
  here->waiting = waiting_;
  here->left = left_;
  return here;
}

void ChunkedContainer::return_to(const Position& position) {
  const auto& there = dynamic_cast<const Here&>(position);
  wanted_ = there.wanted;
  next_chunk_ = there.next_chunk;
  waiting_ = there.waiting;
  left_ = there.left;
  cached_.clear();
}

}  // namespace traverse::bags
