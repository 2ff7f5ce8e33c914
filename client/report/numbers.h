// Numbers in the form in which people read them.

#ifndef TRAVERSE_CLIENT_REPORT_NUMBERS_H_
#define TRAVERSE_CLIENT_REPORT_NUMBERS_H_

#include <string>

namespace traverse::report {

// "31.2 % less", "4.0 % more", "the same": `after` compared with `before`.
std::string Change(double before, double after);

// Gain of `after` over `before` in percent, positive if `after` is less; 0 if both are 0.
double GainPercent(double before, double after);

// "0.4 s", "12 s", "5 min 3 s", "10 h 51 min", "3 d 4 h".
std::string Duration(double seconds);

// "812.4 mm", "15.02 m", "593.3 m", "12.44 km".
std::string Length(double mm);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_NUMBERS_H_
