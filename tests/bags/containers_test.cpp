#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/bags/message_container.hpp"
#include "traverse/files/input_error.hpp"

#include "bags/bag_writers.hpp"
#include "temporary_folder.hpp"
#include "test_data.hpp"

namespace traverse::bags {
namespace {

namespace fs = std::filesystem;
using namespace traverse::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000;
constexpr std::int64_t kMilli = 1'000'000;

/// Sixty messages of three topics; every tenth is large.
std::vector<MadeMessage> made_messages() {
  std::vector<MadeMessage> messages;
  const std::vector<std::string> topics{"/imu", "/points", "/notes"};
  for (std::size_t i = 0; i < 60; ++i) {
    MadeMessage message;
    message.topic = topics[i % 3];
    message.type = i % 3 == 0 ? "sensor_msgs/Imu" : "std_msgs/String";
    message.log_time_ns = kEpoch + static_cast<std::int64_t>(i) * 7 * kMilli;
    message.bytes = "message " + std::to_string(i) + std::string(i % 10 == 0 ? 5000 : i, 'x');
    messages.push_back(message);
  }
  return messages;
}

std::vector<std::size_t> all_channels(const MessageContainer& container) {
  std::vector<std::size_t> channels(container.contents().channels.size());
  std::iota(channels.begin(), channels.end(), 0U);
  return channels;
}

struct Read {
  std::string topic;
  std::int64_t time;
  std::string bytes;
  bool operator==(const Read&) const = default;
};

Read read_of(const MessageContainer& container, const Message& message) {
  return {container.contents().channels.at(message.channel).topic, message.log_time_ns,
          std::string(reinterpret_cast<const char*>(message.bytes.data()), message.bytes.size())};
}

std::vector<Read> read_rest(MessageContainer& container) {
  std::vector<Read> all;
  while (const auto message = container.next()) all.push_back(read_of(container, *message));
  return all;
}

std::vector<Read> read_all(MessageContainer& container) {
  container.begin(all_channels(container));
  return read_rest(container);
}

std::vector<Read> expected_of(const std::vector<MadeMessage>& messages) {
  std::vector<Read> all;
  for (const MadeMessage& message : messages) {
    all.push_back({message.topic, message.log_time_ns, message.bytes});
  }
  return all;
}

std::string losses_of(const MessageContainer& container) {
  std::string text;
  for (const auto& [reason, loss] : container.losses().by_reason()) {
    text += std::to_string(loss.count) + " x " + reason + "; ";
  }
  return text;
}

using Write = std::function<void(const fs::path&, const std::vector<MadeMessage>&)>;
struct Kind {
  std::string name;
  Write write;
  bool is_cut_readable = true;
};

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const bool shuffle : {false, true}) {
    for (const bool has_index : {true, false}) {
      const std::string how =
          std::string(shuffle ? ", shuffled" : "") + (has_index ? "" : ", no index");
      for (const std::string packing : {"none", "bz2", "lz4"}) {
        const ChunkOptions options{packing, 10, shuffle, has_index, true};
        all.push_back({"ROS 1 " + packing + how, [options](const auto& file, const auto& messages) {
                         write_ros1_bag(file, messages, options);
                       }});
      }
      for (const std::string packing : {"none", "lz4", "zstd"}) {
        const ChunkOptions options{packing, 10, shuffle, has_index, true};
        all.push_back({"MCAP " + packing + how, [options](const auto& file, const auto& messages) {
                         write_mcap(file, messages, options);
                       }});
      }
      const ChunkOptions no_chunks{"none", 0, shuffle, has_index, true};
      all.push_back(
          {"MCAP without chunks" + how, [no_chunks](const auto& file, const auto& messages) {
             write_mcap(file, messages, no_chunks);
           }});
    }
  }
  for (const bool has_time_index : {true, false}) {
    for (const bool pack : {true, false}) {
      const DatabaseOptions options{1, pack, false, has_time_index, false};
      all.push_back({std::string("database") + (pack ? ", packed" : "") +
                         (has_time_index ? "" : ", no index of times"),
                     [options](const fs::path& file, const auto& messages) {
                       const fs::path folder = file.string() + ".folder";
                       write_ros2_bag(folder, messages, options);
                       fs::rename(folder / (folder.filename().string() + "_0.db3"), file);
                     },
                     false});
    }
  }
  return all;
}

TEST(Containers, GiveEveryMessageInTheOrderOfTimes) {
  const TemporaryFolder folder;
  const auto messages = made_messages();
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    kind.write(folder / "a", messages);
    const auto container = open_container(folder / "a");
    const Contents& contents = container->contents();
    EXPECT_EQ(contents.messages, 60U);
    EXPECT_EQ(contents.first_ns, messages.front().log_time_ns);
    EXPECT_EQ(contents.last_ns, messages.back().log_time_ns);
    ASSERT_EQ(contents.channels.size(), 3U);
    for (const Channel& channel : contents.channels) {
      EXPECT_EQ(channel.count, 20U);
      EXPECT_EQ(channel.type, channel.topic == "/imu" ? "sensor_msgs/Imu" : "std_msgs/String");
    }
    EXPECT_EQ(read_all(*container), expected_of(messages));
    EXPECT_EQ(read_all(*container), expected_of(messages)) << "a second time";
    const bool says_no_end = losses_of(*container).find("cut short") != std::string::npos;
    EXPECT_TRUE(losses_of(*container).empty() || says_no_end) << losses_of(*container);
  }
}

TEST(Containers, GiveOnlyTheChannelsAskedForAndGoBackToWhereTheyStood) {
  const TemporaryFolder folder;
  const auto messages = made_messages();
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    kind.write(folder / "a", messages);
    const auto container = open_container(folder / "a");
    std::vector<std::size_t> notes;
    for (std::size_t i = 0; i < 3; ++i) {
      if (container->contents().channels[i].topic == "/notes") notes.push_back(i);
    }
    container->begin(notes);
    std::vector<MadeMessage> expected;
    std::copy_if(messages.begin(), messages.end(), std::back_inserter(expected),
                 [](const MadeMessage& message) { return message.topic == "/notes"; });
    EXPECT_EQ(read_rest(*container), expected_of(expected));

    container->begin(all_channels(*container));
    for (int i = 0; i < 17; ++i) container->next();
    const auto there = container->position();
    const auto rest = read_rest(*container);
    EXPECT_EQ(rest.size(), 43U);
    container->return_to(*there);
    EXPECT_EQ(read_rest(*container), rest);
  }
}

TEST(Containers, CutOffAtAnyByteGiveWhatStandsBeforeTheCut) {
  const TemporaryFolder folder;
  const auto messages = made_messages();
  for (const Kind& kind : kinds()) {
    if (!kind.is_cut_readable || kind.name.find("shuffled") != std::string::npos) continue;
    SCOPED_TRACE(kind.name);
    kind.write(folder / "a", messages);
    std::string whole;
    {
      std::ifstream stream(folder / "a", std::ios::binary);
      whole.assign(std::istreambuf_iterator<char>(stream), {});
    }
    std::size_t before = 0;
    for (std::size_t size = 0; size <= whole.size(); size += 97) {
      fs::remove(folder / "cut");  // writing over it would wait for the disk
      std::ofstream(folder / "cut", std::ios::binary) << whole.substr(0, size);
      std::vector<Read> read;
      try {
        const auto container = open_container(folder / "cut");
        read = read_all(*container);
        // Without an index nothing tells of a cut between two records.
        const bool tells_end = kind.name != "ROS 1 none, no index" &&
                               kind.name != "ROS 1 bz2, no index" &&
                               kind.name != "ROS 1 lz4, no index";
        if (read.size() < messages.size() && tells_end) {
          EXPECT_THAT(losses_of(*container), HasSubstr("lost")) << size;
        }
      } catch (const files::InputError&) {
        EXPECT_EQ(before, 0U) << size;
      }
      ASSERT_GE(read.size(), before) << size;
      before = read.size();
      auto expected = expected_of(messages);
      expected.resize(read.size());
      ASSERT_EQ(read, expected) << size;
    }
    EXPECT_GT(before, 55U);
  }
}

TEST(Containers, ADatabaseCutOffGivesWhatStandsBeforeTheCut) {
  const TemporaryFolder folder;
  auto messages = made_messages();
  for (auto& message : messages) message.bytes += std::string(6000, 'y');
  write_ros2_bag(folder / "bag", messages, {1, false, false, true, false});
  const auto size = fs::file_size(folder / "bag/bag_0.db3");
  fs::resize_file(folder / "bag/bag_0.db3", size / 2);
  const auto container = open_container(folder / "bag/bag_0.db3");
  const auto read = read_all(*container);
  EXPECT_GT(read.size(), 20U);
  EXPECT_LT(read.size(), 40U);
  auto expected = expected_of(messages);
  expected.resize(read.size());
  EXPECT_EQ(read, expected);
  EXPECT_THAT(losses_of(*container), HasSubstr("lost"));
}

TEST(Containers, MergeSeveralInTheOrderOfTimes) {
  const TemporaryFolder folder;
  const auto messages = made_messages();
  std::vector<std::vector<MadeMessage>> parts(3);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    parts[i < 20 ? 0 : 1 + i % 2].push_back(messages[i]);  // two overlap
  }
  write_ros1_bag(folder / "b", parts[0]);
  write_ros1_bag(folder / "a", parts[1]);
  write_ros1_bag(folder / "c", parts[2], {"lz4", 5, true, true, true});
  std::vector<std::unique_ptr<MessageContainer>> containers;
  for (const char* name : {"a", "b", "c"}) containers.push_back(open_container(folder / name));
  const auto merged = merge(std::move(containers));
  EXPECT_EQ(merged->contents().messages, 60U);
  EXPECT_EQ(merged->contents().channels.size(), 3U);
  EXPECT_EQ(read_all(*merged), expected_of(messages));

  merged->begin(all_channels(*merged));
  for (int i = 0; i < 30; ++i) merged->next();
  const auto there = merged->position();
  const auto rest = read_rest(*merged);
  merged->return_to(*there);
  EXPECT_EQ(read_rest(*merged), rest);
  EXPECT_EQ(rest.size(), 30U);
}

std::string bytes_of_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Containers, MessagesOfAChannelThatIsNotDescribedCountOnce) {
  const TemporaryFolder folder;
  const auto messages = made_messages();
  for (const bool is_mcap : {false, true}) {
    const ChunkOptions options{"none", 10, false, false, true};
    is_mcap ? write_mcap(folder / "a", messages, options)
            : write_ros1_bag(folder / "a", messages, options);
    std::string bytes = bytes_of_file(folder / "a");
    if (is_mcap) {
      // A record of a kind of its own where the channel stood: before its topic stand the length of
      // that, the numbers of schema and channel, the length of the record and its kind.
      const std::size_t kind = bytes.find("/notes") - 4 - 2 - 2 - 8 - 1;
      ASSERT_EQ(bytes[kind], '\x04');
      bytes[kind] = '\x80';
    } else {
      const std::size_t kind = bytes.rfind("op=\x07", bytes.find("topic=/notes"));
      bytes[kind + 3] = '\x09';
    }
    std::ofstream(folder / "b", std::ios::binary) << bytes;
    const auto container = open_container(folder / "b");
    EXPECT_EQ(container->contents().channels.size(), 2U);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(read_all(*container).size(), 40U);
      EXPECT_THAT(losses_of(*container),
                  HasSubstr("20 x message of a channel that the file does not describe; "));
    }
  }
}

TEST(Containers, RecordsOfOtherKindsInAnMcapFileArePassedOver) {
  const TemporaryFolder folder;
  const auto messages = made_messages();
  for (const std::size_t a_chunk : {0U, 10U}) {
    write_mcap(folder / "a", messages, {"none", a_chunk, false, false, true});
    std::string bytes = bytes_of_file(folder / "a");
    constexpr std::size_t kMagicBytes = 8;
    // Of an application, and one that this version does not know.
    for (const char kind : {'\x80', '\x7f'}) {
      bytes.insert(kMagicBytes, kind + std::string("\x04\0\0\0\0\0\0\0abcd", 12));
    }
    bytes += std::string("\x0f\x04\0\0\0\0\0\0\0\0\0\0\0", 13);  // the end of the messages
    std::ofstream(folder / "b", std::ios::binary) << bytes;
    const auto container = open_container(folder / "b");
    EXPECT_EQ(read_all(*container), expected_of(messages));
    EXPECT_EQ(losses_of(*container), "");
  }
}

TEST(Containers, DamagedChunksCostOnlyThemselves) {
  const TemporaryFolder folder;
  const auto messages = made_messages();
  for (const std::string packing : {"bz2", "lz4"}) {
    write_ros1_bag(folder / "a", messages, {packing, 10, false, true, true});
    std::string bytes;
    {
      std::ifstream stream(folder / "a", std::ios::binary);
      bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    // In the middle of the packed bytes of the second chunk.
    std::size_t at = 0;
    for (int i = 0; i < 2; ++i) at = bytes.find("compression=" + packing, at + 1);
    for (std::size_t i = 0; i < 8; ++i)
      bytes[at + 120 + i] = static_cast<char>(~bytes[at + 120 + i]);
    std::ofstream(folder / "b", std::ios::binary) << bytes;
    const auto container = open_container(folder / "b");
    const auto read = read_all(*container);
    EXPECT_GE(read.size(), 50U);
    EXPECT_LT(read.size(), 60U);
    EXPECT_THAT(losses_of(*container), HasSubstr("1 x damaged " + packing + " data"));
  }
}

TEST(Containers, AChunkThatStatesMoreThanAGigabyteIsRefusedByName) {
  const TemporaryFolder folder;
  const auto messages = made_messages();
  write_ros1_bag(folder / "a", messages, {"lz4", 10, false, true, true});
  std::string bytes;
  {
    std::ifstream stream(folder / "a", std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(stream), {});
  }
  const std::size_t at = bytes.find("size=") + 5;
  bytes.replace(at, 4, std::string("\xff\xff\xff\x7f"));
  std::ofstream(folder / "b", std::ios::binary) << bytes;
  const auto container = open_container(folder / "b");
  EXPECT_EQ(read_all(*container).size(), 50U);
  EXPECT_THAT(losses_of(*container),
              HasSubstr("a chunk of 2147483647 bytes: at most 1073741824 are read at once"));
}

TEST(Containers, OtherFilesAreRefusedByWhatTheyBeginWith) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& bytes) {
    std::ofstream(folder / "x", std::ios::binary) << bytes;
    try {
      open_container(folder / "x");
    } catch (const files::InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_THAT(error_of("#ROSBAG V1.2\nxyz"), HasSubstr("'#ROSBAG V1.2'; `rosbag fix`"));
  EXPECT_THAT(error_of("Dear diary"), HasSubstr("begins with 'Dear diary'"));
  EXPECT_THAT(error_of(""), HasSubstr("an empty file"));
  EXPECT_THAT(error_of("\x89MCAP0\r\n"), HasSubstr("messages of a topic"));
  EXPECT_THAT(error_of(std::string("SQLite format 3\0abc", 19)), HasSubstr("a ROS 2 bag"));
}

TEST(Containers, RealBagsOfPacketsGiveWhatTheirMetadataTell) {
  const fs::path data = test_data() / "recordings/ros2_packets";
  if (!fs::exists(data)) GTEST_SKIP() << "no recordings beside the repository";
  std::size_t bags = 0;
  for (const auto& entry : fs::recursive_directory_iterator(data)) {
    if (entry.path().extension() != ".db3") continue;
    ++bags;
    const auto container = open_container(entry.path());
    ASSERT_EQ(container->contents().channels.size(), 1U);
    const Channel& channel = container->contents().channels.front();
    EXPECT_THAT(channel.type,
                ::testing::AnyOf("velodyne_msgs/VelodyneScan", "pandar_msgs/PandarScan"));
    EXPECT_EQ(read_all(*container).size(), channel.count);
    EXPECT_GE(channel.count, 4U);
    EXPECT_EQ(losses_of(*container), "");
  }
  EXPECT_EQ(bags, 5U);
}

TEST(Containers, FirstChunksAreUnpackedOnceHoweverOftenOneBegins) {
  const TemporaryFolder folder;
  const fs::path file = folder / "a.bag";
  ChunkOptions options;
  options.packing = "lz4";
  write_ros1_bag(file, made_messages(), options);
  const auto container = open_ros1_bag(file);
  container->begin(all_channels(*container));
  const auto first = container->next();
  ASSERT_TRUE(first);
  const Read before = read_of(*container, *first);
  // What is kept needs the file no more.
  const auto size = fs::file_size(file);
  std::fstream(file, std::ios::binary | std::ios::in | std::ios::out) << std::string(size, '\0');
  container->begin(all_channels(*container));
  const auto again = container->next();
  ASSERT_TRUE(again);
  EXPECT_EQ(read_of(*container, *again), before);
}

}  // namespace
}  // namespace traverse::bags
