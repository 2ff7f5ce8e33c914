// How the process takes memory from the system: for commands that handle files of many megabytes
// and end soon after. What it costs to take a page is a good part of their time.

#ifndef TRAVERSE_CLIENT_FILES_PROCESS_MEMORY_H_
#define TRAVERSE_CLIENT_FILES_PROCESS_MEMORY_H_

#include <string>

namespace traverse {

// From now on freed memory stays with the process, for its next use. Not for a program that goes
// on running when its work is done, such as a server. Call it before the first thread begins.
void KeepFreedMemory();

// Gives `text` room for `bytes` bytes, as reserve() does. Where that is many megabytes, the system
// is asked for large pages.
void ReserveLarge(std::string& text, size_t bytes);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_PROCESS_MEMORY_H_
