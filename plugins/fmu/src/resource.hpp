// From fmuResourceLocation to a file. Importers write this URI in many ways: file:/path,
// file:///path, four slashes, localhost, a trailing slash, percent-encoded or raw, or a plain path.
#pragma once

#include <string>
#include <vector>

namespace railpatch::fmu {

// Paths to try, best first; "+" stays "+", and what is no valid %xx stays as it is.
std::vector<std::string> resource_folders(const std::string &location);

// Reads a file of the resource folder. False where none of the folders holds it: tried then lists
// the paths. Throws std::bad_alloc.
bool read_resource(const std::string &location, const char *name, std::string &content,
                   std::string &tried);

// A file by its path, as the operating system has it or as a URI "file:...". The same otherwise.
bool read_path(const std::string &path, std::string &content, std::string &tried);

}  // namespace railpatch::fmu
