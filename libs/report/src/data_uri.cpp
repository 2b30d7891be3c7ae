#include "data_uri.hpp"

#include <openssl/evp.h>

namespace traverse::report {

std::string png_data_uri(std::string_view png) {
  std::string encoded(4 * ((png.size() + 2) / 3) + 1, '\0');  // OpenSSL ends it with a zero byte
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(encoded.data()),
                                     reinterpret_cast<const unsigned char*>(png.data()),
                                     static_cast<int>(png.size()));
  encoded.resize(static_cast<std::size_t>(length));
  return "data:image/png;base64," + encoded;
}

}  // namespace traverse::report
