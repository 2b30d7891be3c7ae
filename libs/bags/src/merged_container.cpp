#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "traverse/bags/message_container.hpp"
#include "traverse/files/input_error.hpp"

#include "byte_cursor.hpp"
#include "random_access_file.hpp"

namespace traverse::bags {

void Losses::add(const std::string& reason, const std::string& place) {
  constexpr std::size_t kMostPlaces = 10;
  Loss& loss = by_reason_[reason];
  ++loss.count;
  if (loss.first_places.size() < kMostPlaces) loss.first_places.push_back(place);
}

namespace {

/// Parts whose messages are merged; each is read when the time has come to its first one.
class MergedContainer : public MessageContainer {
 public:
  explicit MergedContainer(std::vector<std::unique_ptr<MessageContainer>> parts) {
    for (auto& part : parts) parts_.push_back({std::move(part), {}, {}, false});
    std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
      return a.container->contents().first_ns < b.container->contents().first_ns;
    });
    bool is_first = true;
    for (Part& part : parts_) {
      const Contents& contents = part.container->contents();
      for (const Channel& channel : contents.channels) part.channels.push_back(join(channel));
      contents_.messages += contents.messages;
      if (contents.messages == 0) continue;
      contents_.first_ns =
          is_first ? contents.first_ns : std::min(contents_.first_ns, contents.first_ns);
      contents_.last_ns =
          is_first ? contents.last_ns : std::max(contents_.last_ns, contents.last_ns);
      is_first = false;
    }
    contents_.how = fmt::format("{} files; the first: {}", parts_.size(),
                                parts_.front().container->contents().how);
  }

  const Contents& contents() const override { return contents_; }

  void begin(const std::vector<std::size_t>& channels) override {
    for (Part& part : parts_) {
      std::vector<std::size_t> own;
      for (std::size_t i = 0; i < part.channels.size(); ++i) {
        if (std::count(channels.begin(), channels.end(), part.channels[i]) > 0) own.push_back(i);
      }
      part.container->begin(own);
      part.ahead.reset();
      part.is_begun = false;
    }
    last_.reset();
  }

  std::optional<Message> next() override {
    if (last_) advance(parts_[*last_]);
    last_.reset();
    std::optional<std::int64_t> earliest;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      Part& part = parts_[i];
      if (!part.is_begun) {
        if (earliest && *earliest < part.container->contents().first_ns) break;
        part.is_begun = true;
        advance(part);
      }
      if (part.ahead && (!earliest || part.ahead->log_time_ns < *earliest)) {
        earliest = part.ahead->log_time_ns;
        last_ = i;
      }
    }
    if (!last_) return std::nullopt;
    const Part& part = parts_[*last_];
    Message message = *part.ahead;
    message.channel = part.channels[message.channel];
    return message;
  }

  const Losses& losses() const override {
    losses_ = {};
    for (const Part& part : parts_) {
      for (const auto& [reason, loss] : part.container->losses().by_reason()) {
        for (std::size_t i = 0; i < loss.count; ++i) {
          losses_.add(reason, loss.first_places[std::min(i, loss.first_places.size() - 1)]);
        }
      }
    }
    return losses_;
  }

  double share_read() const override {
    double share = 0;
    for (const Part& part : parts_) share += part.is_begun ? part.container->share_read() : 0;
    return share / static_cast<double>(parts_.size());
  }

  std::shared_ptr<const Position> position() const override {
    auto here = std::make_shared<Here>();
    for (const Part& part : parts_) {
      Here::Standing& standing = here->parts.emplace_back();
      standing.is_begun = part.is_begun;
      standing.position = part.container->position();
      standing.ahead = part.ahead;
      if (part.ahead) standing.bytes.assign(part.ahead->bytes.begin(), part.ahead->bytes.end());
    }
    here->last = last_;
    return here;
  }

  void return_to(const Position& position) override {
    const auto& there = dynamic_cast<const Here&>(position);
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Here::Standing& standing = there.parts[i];
      Part& part = parts_[i];
      part.is_begun = standing.is_begun;
      part.container->return_to(*standing.position);
      part.kept = standing.bytes;
      part.ahead = standing.ahead;
      if (part.ahead) part.ahead->bytes = part.kept;
    }
    last_ = there.last;
  }

 private:
  struct Part {
    std::unique_ptr<MessageContainer> container;
    std::vector<std::size_t> channels;  ///< of the whole, by its own
    std::optional<Message> ahead;       ///< its next message
    bool is_begun = false;
    std::vector<std::byte> kept = {};  ///< bytes of `ahead` behind return_to()
  };
  struct Here : Position {
    struct Standing {
      std::shared_ptr<const Position> position;
      std::optional<Message> ahead;
      std::vector<std::byte> bytes;  ///< of it
      bool is_begun = false;
    };
    std::vector<Standing> parts;
    std::optional<std::size_t> last;
  };

  static void advance(Part& part) { part.ahead = part.container->next(); }

  std::size_t join(const Channel& channel) {
    const auto same = std::find_if(
        contents_.channels.begin(), contents_.channels.end(), [&](const Channel& other) {
          return other.topic == channel.topic && other.type == channel.type &&
                 other.encoding == channel.encoding && other.definition == channel.definition;
        });
    const auto index = static_cast<std::size_t>(same - contents_.channels.begin());
    if (same == contents_.channels.end()) {
      contents_.channels.push_back(channel);
    } else {
      same->count += channel.count;
    }
    return index;
  }

  std::vector<Part> parts_;
  Contents contents_;
  mutable Losses losses_;
  std::optional<std::size_t> last_;  ///< part whose message was given
};

}  // namespace

std::unique_ptr<MessageContainer> merge(std::vector<std::unique_ptr<MessageContainer>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<MergedContainer>(std::move(parts));
}

std::unique_ptr<MessageContainer> open_container(const std::filesystem::path& file) {
  if (is_ros1_bag(file)) return open_ros1_bag(file);
  if (is_mcap(file)) return open_mcap(file);
  if (is_sqlite(file)) return open_sqlite_bag(file);
  const std::vector<std::byte> begin = first_bytes(file, 16);
  throw files::InputError(
      file, files::Place::whole_file(), "a ROS 1 bag, a ROS 2 database or an MCAP file",
      begin.empty() ? "an empty file"
                    : "a file that begins with " + files::in_quotes(ByteCursor::as_text(begin)));
}

}  // namespace traverse::bags
