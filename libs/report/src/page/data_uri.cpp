#include "page/data_uri.hpp"

#include <openssl/evp.h>

namespace traverse::report {

std::string base64(std::string_view bytes) {
  std::string encoded(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // OpenSSL ends it with a zero byte
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(encoded.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<int>(bytes.size()));
  encoded.resize(static_cast<std::size_t>(length));
  return encoded;
}

std::string data_uri(std::string_view type, std::string_view bytes) {
  std::string uri = "data:";
  uri.append(type).append(";base64,").append(base64(bytes));
  return uri;
}

}  // namespace traverse::report
