// What the add-on says: to the out-file that cntc_initializefirst names, else to standard error.
#pragma once

#include <string>

namespace contact_addon {

// The file is made when the first line is written to it; also_screen: to standard error too. With
// no name lines go to standard error alone.
void open_log(const std::string &path, bool also_screen);
void close_log();
// One line; where: the call, or empty.
void say(const std::string &where, const std::string &text);

}  // namespace contact_addon
