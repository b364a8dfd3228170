// A profile that is read at run time: the form in which scene.txt has profiles, by itself. Text,
// written by railpatch/profiles/prepared.py; readers of other formats are there.
//
//   railpatch-profile 1
//   body wheel|rail
//   name NAME                      with %xx in place of what is no letter or number
//   arc_length COUNT VALUE...      and so y, z, dy, dz
//   end CRC                        CRC-32 of all bytes before this line, hexadecimal
#pragma once

#include <array>
#include <string>
#include <vector>

namespace railpatch::fmu {

struct ProfileFile {
  std::string path, content;
  bool rail = false;
  std::vector<double> arrays[5];
  double number = 0;  // tells it from others: 1 and its checksum; 0: no file
};

// Wheel left and right, rail left and right; no file: that of the scene.
using ProfileFiles = std::array<ProfileFile, 4>;

// False: problem says what is wrong with the content.
bool parse_profile(const std::string &path, const std::string &content, bool rail,
                   ProfileFile &file, std::string &problem);

// All as bytes, and back; false where these are none.
std::vector<unsigned char> bytes_of(const ProfileFiles &files);
bool files_of(const unsigned char *bytes, size_t size, ProfileFiles &files);

}  // namespace railpatch::fmu
