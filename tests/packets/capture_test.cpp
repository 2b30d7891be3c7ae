#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "traverse/files/input_error.hpp"
#include "traverse/packets/udp_capture.hpp"

#include "packets/made_capture.hpp"
#include "temporary_folder.hpp"

namespace traverse::packets {
namespace {

using testing::MadeCapture;
using testing::TemporaryFolder;

std::vector<std::uint8_t> numbered(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return bytes;
}

struct Read {
  std::vector<std::vector<std::uint8_t>> payloads;
  std::vector<std::int64_t> stamps_ns;
  CaptureCounts counts;
  std::string fault;
};

Read read(const MadeCapture& made) {
  const TemporaryFolder folder;
  made.write(folder / "made.pcap");
  EXPECT_TRUE(is_capture(folder / "made.pcap"));
  UdpCapture capture(folder / "made.pcap");
  Read read;
  while (const auto datagram = capture.next()) {
    read.payloads.emplace_back(datagram->payload.begin(), datagram->payload.end());
    read.stamps_ns.push_back(datagram->arrival.nanoseconds);
    EXPECT_EQ(datagram->target_port, 2368);
    EXPECT_EQ(datagram->source[3], 201);
  }
  read.counts = capture.counts();
  read.fault = capture.fault();
  return read;
}

TEST(UdpCapture, GivesDatagramsWithTheNanosecondOfTheirArrival) {
  MadeCapture made;
  made.add_datagram(numbered(1206), 1'700'000'000'123'456'789);
  made.add_frame(MadeCapture::ethernet({1, 2, 3}, {0x08, 0x06}), 1'700'000'000'200'000'000);
  made.add_datagram(numbered(5), 1'700'000'001'000'000'001);
  const Read found = read(made);
  EXPECT_THAT(found.payloads, ::testing::ElementsAre(numbered(1206), numbered(5)));
  EXPECT_THAT(found.stamps_ns,
              ::testing::ElementsAre(1'700'000'000'123'456'789, 1'700'000'001'000'000'001));
  EXPECT_EQ(found.counts.frames, 3U);
  EXPECT_EQ(found.counts.datagrams, 2U);
  EXPECT_EQ(found.counts.not_udp, 1U);
}

TEST(UdpCapture, LooksThroughVlansCookedAndRawFrames) {
  const auto packet = MadeCapture::ipv4(MadeCapture::udp(numbered(30), 2368));
  MadeCapture vlan;
  vlan.add_frame(MadeCapture::ethernet(packet, {0x88, 0xA8, 0, 1, 0x81, 0, 0, 7, 0x08, 0}), 1);
  EXPECT_EQ(read(vlan).payloads.size(), 1U);

  MadeCapture cooked(113);
  std::vector<std::uint8_t> frame(14, 0);
  frame.insert(frame.end(), {0x08, 0x00});
  frame.insert(frame.end(), packet.begin(), packet.end());
  cooked.add_frame(frame, 1);
  EXPECT_EQ(read(cooked).payloads.size(), 1U);

  MadeCapture newer(276);
  frame.assign(20, 0);
  frame[0] = 0x08;
  frame.insert(frame.end(), packet.begin(), packet.end());
  newer.add_frame(frame, 1);
  EXPECT_EQ(read(newer).payloads.size(), 1U);

  MadeCapture raw(101);
  raw.add_frame(packet, 1);
  EXPECT_EQ(read(raw).payloads.size(), 1U);
}

TEST(UdpCapture, PutsFragmentsTogetherInWhateverOrder) {
  const auto datagram = MadeCapture::udp(numbered(4000), 2368);
  const auto part = [&](std::size_t from, std::size_t to, std::uint32_t id) {
    const std::vector<std::uint8_t> bytes(datagram.begin() + static_cast<std::ptrdiff_t>(from),
                                          datagram.begin() + static_cast<std::ptrdiff_t>(to));
    const std::uint32_t more = to < datagram.size() ? 0x2000 : 0;
    return MadeCapture::ethernet(
        MadeCapture::ipv4(bytes, id, more | static_cast<std::uint32_t>(from / 8)));
  };
  MadeCapture made;
  made.add_frame(part(2960, 4008, 1), 1);
  made.add_frame(part(0, 1480, 2), 2);  // of another datagram, whose rest is missing
  made.add_frame(part(0, 1480, 1), 3);
  made.add_frame(part(1480, 2960, 1), 4);
  const Read found = read(made);
  EXPECT_THAT(found.payloads, ::testing::ElementsAre(numbered(4000)));
  EXPECT_THAT(found.stamps_ns, ::testing::ElementsAre(4));
  EXPECT_EQ(found.counts.incomplete, 1U);
}

TEST(UdpCapture, CountsWhatIsCutAndTellsWhereAFileEnds) {
  MadeCapture made;
  auto frame = MadeCapture::ethernet(MadeCapture::ipv4(MadeCapture::udp(numbered(100), 2368)));
  made.add_datagram(numbered(5), 1);
  const std::size_t length = frame.size();
  frame.resize(60);
  made.add_cut_frame(frame, 2, length);
  made.add_frame(frame, 3);
  made.add_datagram(numbered(6), 4);
  Read found = read(made);
  EXPECT_EQ(found.payloads.size(), 2U);
  EXPECT_EQ(found.counts.cut, 2U);
  EXPECT_EQ(found.fault, "");
  made.cut_to(made.size() - 3);
  found = read(made);
  EXPECT_EQ(found.payloads.size(), 1U);
  EXPECT_NE(found.fault, "");
}

TEST(UdpCapture, NoWordOfAFrameIsTrusted) {
  auto frame = MadeCapture::ethernet(MadeCapture::ipv4(MadeCapture::udp(numbered(40), 2368)));
  for (std::size_t at = 0; at < frame.size(); ++at) {
    for (const int value : {0, 1, 0x45, 0x4F, 0x60, 0x86, 0xFF}) {
      auto changed = frame;
      changed[at] = static_cast<std::uint8_t>(value);
      for (const int link : {0, 1, 12, 113, 228, 229, 276}) {
        UdpFrames frames(link);
        frames.add(changed, {});
        frames.add({changed.data(), at}, {});
        frames.finish();
        EXPECT_EQ(frames.counts().frames, 2U);
      }
    }
  }
}

TEST(UdpCapture, AnotherFileIsRefused) {
  const TemporaryFolder folder;
  MadeCapture made(147);
  made.write(folder / "made.pcap");
  EXPECT_THROW(UdpCapture(folder / "made.pcap"), files::InputError);
  made.cut_to(10);
  made.write(folder / "made.pcap");
  EXPECT_THROW(UdpCapture(folder / "made.pcap"), files::InputError);
  EXPECT_FALSE(is_capture(folder / "none.pcap"));
}

}  // namespace
}  // namespace traverse::packets
