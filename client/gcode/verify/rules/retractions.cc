// All in all the primes push as much more than was retracted as in the original: differences that
// are too small for the parts of one link (travel/made_of_parts.cc) add up.

#include <algorithm>
#include <cstdlib>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {

void PrimeBalance::Add(Micro surplus_of_link, uint32_t line, int64_t of_layer) {
  if (std::abs(surplus_of_link) > kPrimeRounding) return;
  ++links;
  surplus += surplus_of_link;
  if (most.line == 0 || surplus_of_link > most.surplus) most = {surplus_of_link, line, of_layer};
  if (least.line == 0 || surplus_of_link < least.surplus) least = {surplus_of_link, line, of_layer};
}

void PrimeBalance::Append(const PrimeBalance& other) {
  links += other.links;
  surplus += other.surplus;
  if (most.line == 0 || other.most.surplus > most.surplus) most = other.most;
  if (least.line == 0 || other.least.surplus < least.surplus) least = other.least;
}

void ObservePrimes(const LayerPair& layer, LayerFindings& findings) {
  const auto observe = [&layer](const TraceChunk& chunk, uint32_t first, uint32_t end,
                                PrimeBalance& balance) {
    for (uint32_t link = first; link < end; ++link) {
      Micro surplus = 0;
      uint32_t line = 0;  // of the first move of filament
      for (const TraceMove& move : chunk.MovesOf(link)) {
        if (!move.in_print || move.filament == 0) continue;
        surplus += move.filament;
        if (line == 0) line = move.line;
      }
      if (line != 0) balance.Add(surplus, line, layer.index());
    }
  };
  observe(layer.was(), layer.first_path_was(), layer.end_path_was(), findings.was.primes);
  observe(layer.is(), layer.first_path_is(), layer.end_path_is(), findings.is.primes);
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
      {VerifyRule::kRetractions, 0, odd.line, odd.layer,
       absl::StrFormat("primes %.4f mm %s than the original, all in all",
                       static_cast<double>(std::abs(off)) * 1e-6, off > 0 ? "more" : "less")});
}

}  // namespace traverse::gcode
