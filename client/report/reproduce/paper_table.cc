#include "client/report/reproduce/paper_table.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/report/numbers.h"
#include "client/report/table.h"

namespace traverse::report {
namespace {

constexpr int kParts = 8;

// Table 1: over Metodo 1, over Metodo 2; Nc = 2, 10, 400.
constexpr double kGains[2][3][kParts] = {{{2.08, 7.49, 2.05, 3.26, 13.07, 10.68, 10.35, 9.69},
                                          {4.73, 20.87, 3.20, -0.41, 10.13, -1.31, 7.36, 2.26},
                                          {5.43, 25.48, 3.51, -1.41, 4.02, -3.65, 6.57, 0.76}},
                                         {{3.38, 1.98, 1.96, 2.70, 1.99, 4.05, 3.32, 3.57},
                                          {3.54, 4.81, 2.81, 1.46, 3.92, 3.73, 4.16, 4.07},
                                          {3.56, 6.40, 3.04, 1.11, 4.40, 5.66, 4.35, 4.07}}};

void AddRow(Table& table, const std::string& label, const std::vector<double>& gains) {
  std::vector<Cell> row = {Cell{label}};
  double sum = 0;
  for (const double gain : gains) {
    sum += gain;
    row.push_back(Cell{absl::StrFormat("%.2f", gain)});
  }
  row.push_back(Cell{absl::StrFormat("%.2f", sum / static_cast<double>(gains.size()))});
  const auto [least, most] = std::minmax_element(gains.begin(), gains.end());
  row.push_back(Cell{absl::StrFormat("%.2f", *least)});
  row.push_back(Cell{absl::StrFormat("%.2f", *most)});
  table.Add(std::move(row));
}

std::string GainTable(const ReproduceForm& form, const OutcomeOfRun& outcome, int over) {
  std::vector<std::string> header = {"ganho (%)"};
  for (int part = 1; part <= kParts; ++part) header.push_back(absl::StrCat("peça ", part));
  for (const char* name : {"média", "menor", "maior"}) header.push_back(name);
  Table table(header);
  const std::string base = over == 0 ? GreedyMethod() : Ni2optMethod();
  bool any = false;
  for (size_t nc = 0; nc < std::size(kCleanings); ++nc) {
    std::vector<double> gains;
    for (const std::string& part : form.paper_parts) {
      const RunOutcome* before = outcome(PaperRun(part, base, kCleanings[nc], form));
      const RunOutcome* after = outcome(PaperRun(part, ReleaseMethod(), kCleanings[nc], form));
      if (before == nullptr || after == nullptr) break;
      gains.push_back(GainPercent(before->TotalMm(), after->TotalMm()));
    }
    if (gains.size() != kParts) continue;
    any = true;
    AddRow(table, kCleanings[nc] > 0 ? absl::StrCat("Nc = ", kCleanings[nc]) : "sem limpeza",
           gains);
    const double(&theirs)[kParts] = kGains[over][nc];
    AddRow(table, "  artigo", std::vector<double>(theirs, theirs + kParts));
  }
  if (!any) return "";
  return absl::StrFormat(
             "\nTabela 1 - Ganho (%%) do Método 3 em relação ao Método %d, %d camadas\n", over + 1,
             form.paper_layers) +
         table.Text();
}

}  // namespace

std::string PaperTable(const ReproduceForm& form, const OutcomeOfRun& outcome) {
  std::string text = GainTable(form, outcome, 0) + GainTable(form, outcome, 1);
  if (text.empty()) return text;
  absl::StrAppend(&text, "Nossas peças: ");
  for (size_t p = 0; p < form.paper_parts.size(); ++p) {
    absl::StrAppend(&text, p > 0 ? ", " : "", p + 1, " ", form.paper_parts[p]);
  }
  return text + ". As camadas de cada arquivo se repetem; limpeza em (0, 0).\n";
}

}  // namespace traverse::report
