// CRC-32 as of IEEE 802.3 (polynomial 0x04c11db7, reflected): the checksum of PNG and gzip.
#pragma once

#include <cstdint>
#include <string_view>

namespace raygrain {

uint32_t crc32(std::string_view bytes);

}  // namespace raygrain
