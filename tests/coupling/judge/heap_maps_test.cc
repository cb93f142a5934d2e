// Pictures of heaps' fits: maps, posteriors, models of one field.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "continuum/closed/osl.h"
#include "coupling/fit/ensemble_fit.h"
#include "coupling/fit/fit_report.h"
#include "coupling/fit/fit_tables.h"
#include "coupling/observe/setup.h"
#include "tests/coupling/stressed_heap.h"

namespace grainfield::coupling {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kSlope = 28;

EnsembleFits fits_of(int heaps, std::vector<std::string> models, double noise = 0.05) {
  FitSetup setup;
  setup.models = std::move(models);
  setup.bootstrap = 4;
  setup.heights = {0.2, 0.4};
  const auto field =
      continuum::osl_field(kSlope * std::numbers::pi / 180, {0.74, -0.31}, test::lattice_rho_g());
  const HeapReader reader{static_cast<std::size_t>(heaps),
                          [=](std::size_t k) {
                            return test::stressed_heap(
                                {kSlope, kSlope, 0.01, 30, 0, 0, noise, k + 1},
                                [&](double x, double y) { return field.stress(x, y); });
                          },
                          [](std::size_t k) { return "heap " + std::to_string(k); }};
  return fit_heaps(setup, observe_heaps(setup, reader, 1), 1);
}

std::vector<std::string> titles_of(const std::vector<Section>& sections) {
  std::vector<std::string> out;
  for (const Section& s : sections) {
    std::visit([&](const auto& one) { out.push_back(one.title); }, s);
  }
  return out;
}

// A model is a line between the few places of the data, and goes through its values there.
TEST(HeapMaps, LinesOfModelsAreFinerThanTheData) {
  const EnsembleFits fits = fits_of(2, {"osl", "cantelaube_plus"});
  const FitData& data = fits.observed.data;
  const std::vector<int> rows = rows_at(data, 0, 0);
  ASSERT_LT(rows.size(), static_cast<std::size_t>(kFewPlaces));
  const auto seen = models_at(fits, {"osl", "cantelaube_plus"}, data.points(rows, Eigen::all));
  const auto column = data.components.front() == "sigma_xx" ? 0 : 1;
  EXPECT_LT((seen[1].col(column) - fit_of(fits.fits, "cantelaube_plus").model(rows)).norm(),
            1e-9 * seen[1].col(column).norm());
  for (const Frame& frame : profile_frames(fits, "sigma_yy")) {
    ASSERT_EQ(frame.series.size(), 3U);
    const Series& grains = frame.series.front();
    for (const std::size_t k : {1U, 2U}) {
      const Series& line = frame.series[k];
      ASSERT_EQ(line.x.size(), kDrawnPlaces);
      EXPECT_EQ(line.x[0], grains.x.minCoeff());
      EXPECT_EQ(line.x[kDrawnPlaces - 1], grains.x.maxCoeff());
      EXPECT_GT(line.y.maxCoeff(), 0);
    }
  }
}

TEST(HeapMaps, TheTrueModelIsTheGrainsWithinTheNoise) {
  const EnsembleFits fits = fits_of(4, {"osl", "hydrostatic"});
  const StressMaps& m = fits.observed.maps;
  ASSERT_EQ(m.points.rows(), m.columns * m.rows);
  const Eigen::MatrixXd osl = model_on_maps(fits, "osl");
  const Eigen::MatrixXd hydrostatic = model_on_maps(fits, "hydrostatic");
  double off = 0, far = 0, all = 0;
  int inside = 0;
  const double slope = std::tan(fits.observed.facts.slope_deg * std::numbers::pi / 180);
  for (Eigen::Index p = 0; p < m.points.rows(); ++p) {
    const double x = m.points(p, 0), y = m.points(p, 1);
    EXPECT_EQ(std::isfinite(osl(p, 0)), m.mean.row(p).allFinite());
    if (y + std::fabs(x) * slope > 0 || 1 + y < fits.observed.kernel->range() / 2) {
      EXPECT_TRUE(m.mean.row(p).array().isNaN().all());
    }
    // Well inside: the kernel's range is 0.15 h, the lattice's steps end at the flanks.
    if (y + std::fabs(x) * slope > -0.2 || y < -0.8) continue;
    ++inside;
    off += (m.mean.row(p) - osl.row(p)).squaredNorm();
    far += (m.mean.row(p) - hydrostatic.row(p)).squaredNorm();
    all += m.mean.row(p).squaredNorm();
  }
  ASSERT_GT(inside, 100);
  // As far from the model as on the lines of the fit: the noise, and the measured slope and
  // density.
  EXPECT_NEAR(std::sqrt(off / all), fit_of(fits.fits, "osl").rel_l2, 0.02);
  EXPECT_LT(std::sqrt(off / all), 0.08);
  EXPECT_GT(std::sqrt(far / all), 0.2);
}

TEST(HeapMaps, ThePageHasMapsYieldAndPosteriors) {
  const auto sections = fit_pictures(fits_of(4, {"osl", "hydrostatic"}));
  const auto titles = titles_of(sections);
  EXPECT_THAT(titles, Contains("Grains, model and residual"));
  EXPECT_THAT(titles, Contains("Where osl fails"));
  EXPECT_THAT(titles, Contains("Mohr-Coulomb expression"));
  EXPECT_THAT(titles, Contains("What the data say of the constants"));
  // One heap knows no errors: neither residuals in standard errors nor densities.
  const auto one = titles_of(fit_pictures(fits_of(1, {"osl", "hydrostatic"})));
  EXPECT_THAT(one, Contains("Grains, model and residual"));
  EXPECT_THAT(one, ::testing::Not(Contains(HasSubstr("What the data say"))));
  EXPECT_THAT(one, ::testing::Not(Contains(HasSubstr("Where "))));
}

TEST(HeapMaps, ModelsOfOneFieldShareALine) {
  const auto sections =
      fit_pictures(fits_of(4, {"osl", "cantelaube_zero", "bcc", "cantelaube_plus", "fpa"}));
  const Picture& picture = std::get<Picture>(sections.front());
  EXPECT_TRUE(picture.program.find("bcc, cantelaube_zero") != std::string::npos ||
              picture.program.find("cantelaube_zero, bcc") != std::string::npos);
  // The line that the double one took goes to the fifth model.
  EXPECT_THAT(picture.program, HasSubstr("fpa"));
}

}  // namespace
}  // namespace grainfield::coupling
