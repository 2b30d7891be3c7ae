#include "traverse/packets/udp_capture.hpp"

#include <algorithm>
#include <array>
#include <dlfcn.h>
#include <fstream>
#include <pcap/pcap.h>

#include <fmt/format.h>

#include "traverse/files/input_error.hpp"

namespace traverse::packets {

namespace {

/// What is used of libpcap, loaded with the first capture, so that a program that meets none starts
/// without. It stays loaded.
struct PcapLibrary {
  decltype(&::pcap_open_offline_with_tstamp_precision) open = nullptr;
  decltype(&::pcap_next_ex) next = nullptr;
  decltype(&::pcap_datalink) datalink = nullptr;
  decltype(&::pcap_geterr) error = nullptr;
  decltype(&::pcap_close) close = nullptr;
  std::string fault;  ///< why it cannot be used; empty: it can

  PcapLibrary() {
    void* library = ::dlopen("libpcap.so.0.8", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      fault = ::dlerror();
      return;
    }
    load(library, "pcap_open_offline_with_tstamp_precision", open);
    load(library, "pcap_next_ex", next);
    load(library, "pcap_datalink", datalink);
    load(library, "pcap_geterr", error);
    load(library, "pcap_close", close);
  }

 private:
  template <typename Function>
  void load(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(::dlsym(library, name));
    if (function == nullptr) fault = fmt::format("it has no function {}", name);
  }
};

const PcapLibrary& pcap_library() {
  static const PcapLibrary library;
  return library;
}

}  // namespace

struct UdpCapture::State {
  std::filesystem::path file;
  pcap_t* capture = nullptr;
  std::optional<UdpFrames> frames;
  std::string fault;
  std::uint64_t bytes = 0;
  ~State() {
    if (capture != nullptr) pcap_library().close(capture);
  }
};

UdpCapture::UdpCapture(const std::filesystem::path& file) : state_(std::make_unique<State>()) {
  state_->file = file;
  const PcapLibrary& library = pcap_library();
  if (!library.fault.empty()) {
    throw files::InputError(file, files::Place::whole_file(),
                            "the library that reads captures, of the package libpcap0.8",
                            library.fault);
  }
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  state_->capture = library.open(file.c_str(), PCAP_TSTAMP_PRECISION_NANO, error.data());
  if (state_->capture == nullptr) {
    throw files::InputError(file, files::Place::whole_file(), "a capture (.pcap, .pcapng)",
                            error.data());
  }
  const int link = library.datalink(state_->capture);
  if (!UdpFrames::knows(link)) {
    throw files::InputError(file, files::Place::whole_file(),
                            "frames of Ethernet, Linux cooked, loopback or raw IP",
                            fmt::format("link type {}", link));
  }
  state_->frames.emplace(link);
}

UdpCapture::~UdpCapture() = default;

std::optional<Datagram> UdpCapture::next() {
  if (!state_->fault.empty()) return std::nullopt;
  for (;;) {
    pcap_pkthdr* header = nullptr;
    const u_char* bytes = nullptr;
    const int result = pcap_library().next(state_->capture, &header, &bytes);
    if (result != 1) {
      if (result == PCAP_ERROR) state_->fault = pcap_library().error(state_->capture);
      state_->frames->finish();
      return std::nullopt;
    }
    state_->bytes += header->caplen;
    if (header->caplen < header->len) {
      ++state_->frames->counts().frames;
      ++state_->frames->counts().cut;
      continue;
    }
    // With that precision the microseconds are nanoseconds. A .pcapng tells any 64 bits.
    constexpr std::int64_t kFarthest_s = 9'000'000'000;
    const std::int64_t seconds =
        std::clamp(static_cast<std::int64_t>(header->ts.tv_sec), -kFarthest_s, kFarthest_s);
    const geometry::Stamp arrival{seconds * 1'000'000'000 +
                                  static_cast<std::int64_t>(header->ts.tv_usec)};
    if (auto datagram = state_->frames->add({bytes, header->caplen}, arrival)) return datagram;
  }
}

const CaptureCounts& UdpCapture::counts() const { return state_->frames->counts(); }
const std::string& UdpCapture::fault() const { return state_->fault; }
std::uint64_t UdpCapture::bytes_read() const { return state_->bytes; }

bool is_capture(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::array<char, 4> magic{};
  if (!in.read(magic.data(), magic.size())) return false;
  const std::string found(magic.begin(), magic.end());
  for (const char* known : {"\xD4\xC3\xB2\xA1", "\xA1\xB2\xC3\xD4", "\x4D\x3C\xB2\xA1",
                            "\xA1\xB2\x3C\x4D", "\x0A\x0D\x0D\x0A"}) {
    if (found == known) return true;
  }
  return false;
}

}  // namespace traverse::packets
