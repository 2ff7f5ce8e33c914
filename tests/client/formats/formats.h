// A short .damat text.

#ifndef TRAVERSE_TESTS_CLIENT_FORMATS_FORMATS_H_
#define TRAVERSE_TESTS_CLIENT_FORMATS_FORMATS_H_

namespace traverse {

inline const char kDamatText[] = "// any comment\nM,1,1\nnF,1\nF1,1\nI1,1,0\nC1,X1,Y2\n";

}  // namespace traverse

#endif  // TRAVERSE_TESTS_CLIENT_FORMATS_FORMATS_H_
