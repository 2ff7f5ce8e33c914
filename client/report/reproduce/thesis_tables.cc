#include "client/report/reproduce/thesis_tables.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/report/numbers.h"
#include "client/report/reproduce/sample.h"
#include "client/report/reproduce/thesis_columns.h"
#include "client/report/reproduce/thesis_values.h"
#include "client/report/table.h"

namespace traverse::report {
namespace {

using thesis::kNa;

class Tables {
 public:
  Tables(const ReproduceForm& form, const OutcomeOfRun& outcome)
      : form_(form), outcome_(outcome), columns_(ThesisColumns(form)) {}

  std::string All() const {
    return absl::StrCat(Parameters(), SampleTable(), Points(), Distances(), Deviations(), Visible(),
                        QuickTimes(), MilpTimes(), Programmes(), TabuTimes(0), TabuTimes(1),
                        Projection());
  }

 private:
  using Value = double (*)(const RunOutcome&);

  // For one part: a column's value in each run; empty if the column was not run or has no route.
  std::vector<double> Values(int part, const ThesisColumn& column, const Value& value) const {
    std::vector<double> values;
    for (int seed = 1; seed <= (column.samples ? form_.seeds : 1); ++seed) {
      const RunOutcome* found = outcome_(ThesisRun(kThesisParts[part], column.method, seed, form_));
      if (found == nullptr) continue;
      if (column.programme && !found->HasRoute()) continue;
      values.push_back(value(*found));
    }
    return values;
  }
  double Mean(int part, const ThesisColumn& column, const Value& value) const {
    const std::vector<double> values = Values(part, column, value);
    return values.empty() ? kNa : SampleOf(values).mean;
  }

  static std::string Number(double value, const char* format) {
    if (std::isnan(value)) return "NA";
    return absl::StrFormat(*absl::ParsedFormat<'f'>::New(format), value);
  }
  static void AddRow(Table& table, const std::string& label, const std::vector<double>& values,
                     const char* format = "%.2f") {
    std::vector<Cell> row = {Cell{label}};
    for (const double value : values) row.push_back(Cell{Number(value, format)});
    table.Add(std::move(row));
  }

  static std::string Titled(const std::string& title, const Table& table,
                            const std::string& note = "") {
    return absl::StrCat("\n", title, "\n", table.Text(), note.empty() ? "" : note + "\n");
  }

  std::string Parameters() const {
    Table table({"Parâmetros", "nosso", "tese"});
    const int n = form_.first_samples;
    AddText(table, {"Grau confiança", "95%", "95%"});
    AddText(table, {"Valor Alpha", "5%", "5%"});
    AddText(table, {"Tolerância (k)", "10%", "10%"});
    AddText(table, {"Amostras iniciais (n)", absl::StrCat(n), "10"});
    AddText(table, {"Graus liberdade", absl::StrCat(n - 1), "9"});
    AddText(table, {"Valor T (alpha/2;GL)", absl::StrFormat("%.3f", n > 1 ? StudentT(n - 1) : 0),
                    "2.262"});
    return Titled("Tabela 3.1 - Parâmetros da quantidade de amostras necessárias", table);
  }

  static void AddText(Table& table, const std::vector<std::string>& cells) {
    std::vector<Cell> row;
    for (const std::string& cell : cells) row.push_back(Cell{cell});
    table.Add(std::move(row));
  }

  std::string SampleTable() const {
    std::vector<std::string> header = {"amostras iniciais"};
    std::vector<std::vector<double>> columns;
    for (const char* step : {"c_mm", "crs_mm"}) {
      for (const int diversifications : form_.diversifications) {
        header.push_back(absl::StrCat(step[1] == '_' ? "Contorno " : "Raster ", diversifications));
        std::vector<double>& values = columns.emplace_back();
        for (int seed = 1; seed <= form_.first_samples; ++seed) {
          const RunOutcome* found = outcome_(SampleRun(diversifications, seed));
          if (found != nullptr) values.push_back(found->Get(step));
        }
        if (values.empty()) return "";
      }
    }
    Table table(header);
    std::vector<std::vector<double>> rows(3);
    for (size_t i = 0; i < columns.front().size(); ++i) {
      std::vector<double> row;
      for (const auto& column : columns) row.push_back(i < column.size() ? column[i] : kNa);
      AddRow(table, absl::StrCat(i + 1), row);
    }
    std::vector<double> theirs[3];
    for (size_t c = 0; c < columns.size(); ++c) {
      const Sample sample = SampleOf(columns[c]);
      rows[0].push_back(sample.mean);
      rows[1].push_back(sample.deviation);
      rows[2].push_back(SamplesNeeded(sample));
      for (int k = 0; k < 3; ++k) theirs[k].push_back(thesis::kSamples[c][k]);
    }
    const char* names[] = {"Média", "Desvio padrão", "Amostras necessárias (n)"};
    for (int k = 0; k < 3; ++k) {
      AddRow(table, names[k], rows[static_cast<size_t>(k)]);
      AddRow(table, "  tese", theirs[k]);
    }
    return Titled("Tabela 3.2 - Cálculo da quantidade amostral (peça 2, camada 1, eq. 3.2)", table,
                  absl::StrFormat("Amostras realizadas (n): %d; tese: 5", form_.seeds));
  }

  std::string Points() const {
    Table table({"peça", "pontos", "Análise de Ilhas", "SP", "NRP", "BBCP"});
    const ThesisColumn nrp = columns_[6], bbcp = columns_[8];
    for (int part = 0; part < 3; ++part) {
      const double layers = Mean(part, nrp, [](const RunOutcome& o) { return o.Get("layers"); });
      if (std::isnan(layers)) continue;
      std::vector<std::string> ours = {absl::StrCat(part + 1)}, theirs = {"  tese"};
      const char* names[] = {"points_entries", "points_island_analysis", "points_sp", "points_nrp",
                             "points_bbcp"};
      double all = 0;
      for (int k = 0; k < 5; ++k) {
        const double points =
            outcome_(ThesisRun(kThesisParts[part], k < 4 ? nrp.method : bbcp.method, 1, form_))
                ->Get(names[k], kNa) /
            layers;
        if (k == 0) all = points;
        ours.push_back(WithReduction(points, all, k > 0));
        theirs.push_back(WithReduction(thesis::kPoints[part][k], thesis::kPoints[part][0], k > 0));
      }
      AddText(table, ours);
      AddText(table, theirs);
    }
    return Titled("Tabela 5.1 - Quantidade de dados antes e depois do pré-processamento (Passo 1)",
                  table, "Peças 2 e 3 da tese conforme seu texto: 17 ilhas são a peça 2.");
  }

  static std::string WithReduction(double points, double all, bool reduction) {
    return reduction ? absl::StrFormat("%.0f (%.1f%%)", points, GainPercent(all, points))
                     : absl::StrFormat("%.0f", points);
  }

  std::string Distances() const {
    std::vector<std::string> header = {"peça, mm"};
    for (const ThesisColumn& column : columns_) header.push_back(column.title);
    Table table(header);
    for (int part = 0; part < 3; ++part) AddDistances(part, table);
    return Titled(
        absl::StrFormat("Tabela 5.2 - Distâncias de reposicionamento e ganho (redução), %d camadas",
                        form_.thesis_layers),
        table,
        absl::StrFormat("BT: média de %d execuções (tese: 5). MILP: partida a frio, %g s por "
                        "programa (tese: 7200); NA: nenhuma rota nesse tempo.",
                        form_.seeds, form_.programme_seconds));
  }

  void AddDistances(int part, Table& table) const {
    const auto row = [&](const Value& value) {
      std::vector<double> values;
      for (const ThesisColumn& column : columns_) values.push_back(Mean(part, column, value));
      return values;
    };
    const auto theirs = [&](const double(&values)[thesis::kMethods]) {
      return std::vector<double>(values, values + thesis::kMethods);
    };
    const std::string name = absl::StrCat(part + 1, " ");
    AddRow(table, name + "Rota-C", row([](const RunOutcome& o) { return o.Get("c_mm"); }));
    AddRow(table, "  tese", theirs(thesis::kContours[part]));
    AddRow(table, name + "Rota-CRS", row([](const RunOutcome& o) { return o.Get("crs_mm"); }));
    AddRow(table, "  tese", theirs(thesis::kRasters[part]));
    const std::vector<double> total = row([](const RunOutcome& o) { return o.TotalMm(); });
    const std::vector<double> their_total = theirs(thesis::kTotals[part]);
    AddRow(table, name + "Total", total);
    AddRow(table, "  tese", their_total);
    AddRow(table, name + "Tempo ocioso (s)", Idle(total));
    AddRow(table, "  tese", Idle(their_total));
    const char* over[] = {"NO", "Guloso", "NI2OPT"};
    for (size_t base = 0; base < 3; ++base) {
      AddRow(table, absl::StrCat(name, "Ganho sobre ", over[base], " (%)"), Gains(total, base),
             "%.1f");
      AddRow(table, "  tese", Gains(their_total, base), "%.1f");
    }
  }

  static std::vector<double> Idle(std::vector<double> lengths) {
    for (double& mm : lengths) mm /= kIdleSpeed;
    return lengths;
  }
  static std::vector<double> Gains(const std::vector<double>& totals, size_t base) {
    std::vector<double> gains;
    for (const double total : totals) {
      gains.push_back(std::isnan(total) ? kNa : GainPercent(totals[base], total));
    }
    return gains;
  }

  std::string Deviations() const {
    Table table({"peça, modelo", "Média", "DP", "n", "tese: Média", "DP Médio"});
    for (int part = 0; part < 3; ++part) {
      for (size_t c = 6; c < columns_.size(); ++c) {
        const std::vector<double> totals =
            Values(part, columns_[c], [](const RunOutcome& o) { return o.TotalMm(); });
        if (totals.empty()) continue;
        const Sample sample = SampleOf(totals);
        AddText(table, {absl::StrCat(part + 1, " ", columns_[c].title), Number(sample.mean, "%.2f"),
                        Number(sample.deviation, "%.2f"), absl::StrCat(sample.size),
                        Number(thesis::kTotals[part][c], "%.2f"),
                        Number(thesis::kDeviations[part][c - 6], "%.2f")});
      }
    }
    return Titled("Tabela 5.3 - Média e desvio padrão (DP) das execuções com BT", table);
  }

  std::string Visible() const {
    Table table({"peça", "SP", "VP NRP", "redução (%)", "VP BBCP", "redução (%)"});
    for (int part = 0; part < 3; ++part) {
      const auto of = [&](const char* name, size_t column) {
        const RunOutcome* found =
            outcome_(ThesisRun(kThesisParts[part], columns_[column].method, 1, form_));
        return found == nullptr ? kNa : found->Get(name, kNa) / found->Get("layers", 1);
      };
      const double sp = of("points_sp", 6);
      if (std::isnan(sp)) continue;
      const double nrp = of("points_vp", 6), bbcp = of("points_vp", 8);
      AddRow(table, absl::StrCat(part + 1),
             {sp, nrp, GainPercent(sp, nrp), bbcp, GainPercent(sp, bbcp)}, "%.1f");
      const double their_sp = thesis::kPoints[part][2];
      AddRow(table, "  tese",
             {their_sp, thesis::kVisible[part][0], GainPercent(their_sp, thesis::kVisible[part][0]),
              thesis::kVisible[part][1], GainPercent(their_sp, thesis::kVisible[part][1])},
             "%.1f");
    }
    return Titled("Tabela 5.4 - Média da quantidade de pontos após os polígonos de visibilidade",
                  table);
  }

  std::string QuickTimes() const {
    Table table({"peça", "Guloso", "NI2OPT", "tese: Guloso", "NI2OPT"});
    for (int part = 0; part < 3; ++part) {
      const Value seconds = [](const RunOutcome& o) { return o.Get("solve_seconds"); };
      AddRow(table, absl::StrCat(part + 1),
             {Mean(part, columns_[1], seconds), Mean(part, columns_[2], seconds),
              thesis::kQuickSeconds[part][0], thesis::kQuickSeconds[part][1]},
             "%.4f");
    }
    return Titled("Tabela 5.5 - Tempo de processamento (s): Guloso e NI2OPT", table);
  }

  std::vector<double> Steps(int part, const ThesisColumn& column) const {
    return {Mean(part, column, [](const RunOutcome& o) { return o.Get("step2_seconds"); }),
            Mean(part, column, [](const RunOutcome& o) { return o.Get("step3_seconds"); }),
            Mean(part, column, [](const RunOutcome& o) { return o.Get("step4_seconds"); })};
  }

  std::string StepTable(const std::string& title, const std::vector<size_t>& columns,
                        const std::function<double(int, size_t)>& theirs) const {
    std::vector<std::string> header = {"peça"};
    for (const size_t c : columns) {
      for (const char* step : {" 2", " 3", " 4", " total"}) {
        header.push_back(columns_[c].title + step);
      }
    }
    Table table(header);
    for (int part = 0; part < 3; ++part) {
      std::vector<double> ours, their;
      for (size_t i = 0; i < columns.size(); ++i) {
        const std::vector<double> steps = Steps(part, columns_[columns[i]]);
        double sum = 0, their_sum = 0;
        for (size_t k = 0; k < 3; ++k) {
          ours.push_back(steps[k]);
          their.push_back(theirs(part, 3 * i + k));
          sum += steps[k];
          their_sum += their.back();
        }
        ours.push_back(sum);
        their.push_back(their_sum);
      }
      AddRow(table, absl::StrCat(part + 1), ours, "%.3f");
      AddRow(table, "  tese", their, "%.1f");
    }
    return Titled(title, table);
  }

  std::string MilpTimes() const {
    return StepTable("Tabela 5.6 - Tempo de processamento nos modelos MILP (s), passos 2, 3 e 4",
                     {3, 4, 5}, [](int part, size_t k) { return thesis::kMilpSeconds[part][k]; });
  }

  std::string TabuTimes(int which) const {
    const size_t shift = static_cast<size_t>(which);
    return StepTable(
        absl::StrFormat("Tabela 5.%d - Tempo de processamento da BT (s), %d diversificações",
                        7 + which, form_.diversifications[which]),
        {6 + shift, 8 + shift},
        [which](int part, size_t k) { return thesis::kTabuSeconds[which][part][k]; });
  }

  // The thesis does not print this: the programmes' results, with a cold start and with ni2opt's
  // route.
  std::string Programmes() const {
    Table table({"peça, modelo", "início", "achou", "valor", "ganho (%)", "limite", "nós", "s"});
    for (int part = 0; part < 3; ++part) {
      for (const char* representation : {"sp", "nrp", "bbcp"}) {
        for (const bool cold : {true, false}) AddProgrammes(part, representation, cold, table);
      }
    }
    return Titled(
        "Programas: passos 2 e 4 somados, a frio e a partir de NI2OPT (soma das camadas, mm)",
        table, "ganho: sobre a rota de que o programa partiu; limite: do solver, quando o há.");
  }

  void AddProgrammes(int part, const std::string& representation, bool cold, Table& table) const {
    const RunOutcome* found = outcome_(
        ThesisRun(kThesisParts[part], MilpMethodName(representation, cold, form_), 1, form_));
    if (found == nullptr) return;
    for (const char* step : {"contours", "rasters"}) {
      const auto of = [&](const char* name, double unset = kNa) {
        return found->Get(absl::StrCat(step, name), unset);
      };
      const double start = of("_start");
      AddText(table, {absl::StrFormat("%d %s %s%s", part + 1, representation,
                                      step == std::string("contours") ? "passo 2" : "passo 4",
                                      cold ? ", a frio" : ""),
                      Number(start, "%.1f"),
                      absl::StrFormat("%.0f/%.0f", of("_found", 0), of("_programmes", 0)),
                      Number(of("_value"), "%.1f"),
                      std::isnan(start) ? "" : Number(100 * of("_gained", 0) / start, "%.2f"),
                      Number(of("_bound"), "%.1f"), Number(of("_nodes", 0), "%.0f"),
                      Number(of("_seconds", 0), "%.1f")});
    }
  }

  std::string Projection() const {
    Table table({"peça, horas", "NO", "Guloso", "NI2OPT", "melhor MILP ou BT"});
    for (int part = 0; part < 3; ++part) {
      std::vector<double> hours;
      double best = kNa;
      for (size_t c = 0; c < columns_.size(); ++c) {
        const double total =
            Mean(part, columns_[c], [](const RunOutcome& o) { return o.TotalMm(); });
        const double h = total / kIdleSpeed / 3600 * 400 / form_.thesis_layers;
        if (c < 3) hours.push_back(h);
        if (c >= 3 && !std::isnan(h) && (std::isnan(best) || h < best)) best = h;
      }
      hours.push_back(best);
      AddRow(table, absl::StrCat(part + 1), hours);
      const double* theirs = thesis::kHours[part];
      AddRow(table, "  tese", {theirs[0], theirs[1], theirs[2], theirs[3]});
    }
    return Titled("Figura 5.13 - Projeção dos tempos ociosos (h) para 400 camadas", table);
  }

  const ReproduceForm& form_;
  const OutcomeOfRun& outcome_;
  const std::vector<ThesisColumn> columns_;
};

}  // namespace

std::string ThesisTables(const ReproduceForm& form, const OutcomeOfRun& outcome) {
  return Tables(form, outcome).All();
}

}  // namespace traverse::report
