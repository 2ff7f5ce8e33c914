// All in all the primes push as much more than was retracted as in the original: differences that
// are too small for the parts of one link (travel/made_of_parts.cc) add up.

#include <algorithm>
#include <cstdlib>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {

void PrimeBalance::Add(Micro surplus_of_link, Place at) {
  if (std::abs(surplus_of_link) > kPrimeRounding) return;
  Append({1, surplus_of_link, {surplus_of_link, at}, {surplus_of_link, at}});
}

void PrimeBalance::Append(const PrimeBalance& other) {
  links += other.links;
  surplus += other.surplus;
  if (most.at.line == 0 || other.most.surplus > most.surplus) most = other.most;
  if (least.at.line == 0 || other.least.surplus < least.surplus) least = other.least;
}

void ObservePrimes(const LayerPair& layer, LayerFindings& findings) {
  layer.ForEachLink([&](const LayerSide& side, uint32_t link) {
    Micro surplus = 0;
    uint32_t line = 0;  // of the first move of filament
    for (const TraceMove& move : side.chunk.MovesOf(link)) {
      if (!move.in_print || move.filament == 0) continue;
      surplus += move.filament;
      if (line == 0) line = move.line;
    }
    if (line != 0) findings.Of(side).primes.Add(surplus, {line, layer.index()});
  });
}

void ComparePrimes(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  constexpr Micro kOfEach = 20;
  const Micro off = is.primes.surplus - was.primes.surplus;
  const Micro most_of_link =
      std::max(std::abs(was.primes.most.surplus), std::abs(was.primes.least.surplus));
  const Micro slack = kPrimeRounding + most_of_link * std::abs(is.primes.links - was.primes.links) +
                      kOfEach * is.primes.links;
  if (std::abs(off) <= slack) return;
  const PrimeBalance::Odd& odd = off > 0 ? is.primes.most : is.primes.least;
  breaks.push_back(
      {VerifyRule::kRetractions, 0, odd.at,
       absl::StrFormat("primes %.4f mm %s than the original, all in all",
                       static_cast<double>(std::abs(off)) * kMicro, off > 0 ? "more" : "less")});
}

}  // namespace traverse::gcode
