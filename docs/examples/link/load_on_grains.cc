// Disks that settle on a floor (grainfield::dem), their stress averaged (grainfield::coupling), and
// what a model says of a load on such a layer (grainfield::continuum).
#include <cmath>
#include <cstdio>

#include "continuum/model.h"
#include "coupling/averaging/average.h"
#include "dem/engine/engine.h"

int main() {
  using namespace grainfield;

  // Twelve columns of five disks, 1 cm wide, between two walls.
  dem::EngineSettings settings;
  settings.friction = 0.4;
  settings.time_step = 1e-5;
  const auto engine = dem::make_engine(settings);
  const auto wall = [&](const char* name, double x, double nx, double ny) {
    dem::Wall plane;
    plane.name = name;
    plane.point = {x, 0, 0};
    plane.normal = {nx, ny, 0};
    engine->add_wall(plane);
  };
  wall("floor", 0, 0, 1);
  wall("left", 0, 1, 0);
  wall("right", 0.12, -1, 0);
  double weight = 0;
  for (int k = 0; k < 60; ++k) {
    dem::NewGrain grain;
    grain.radius = 0.005;
    grain.density = 2500;
    grain.x = 0.005 + 0.01 * (k % 12);
    grain.y = 0.005 + 0.0101 * (k / 12);
    engine->add(grain);
    weight += grain.density * 3.141592653589793 * grain.radius * grain.radius * 9.81;
  }
  engine->set_background_damping(50);
  engine->step(100000);

  double carried = 0;
  for (const dem::Wall& w : engine->walls()) carried -= w.force.y();
  std::printf("walls carry %.4f of the weight after %ld steps\n", carried / weight,
              engine->steps());

  coupling::AverageOptions options;
  options.width = 0.01;
  Eigen::MatrixXd points(1, 2);
  points << 0.06, 0.02;
  const coupling::Field field = coupling::average(engine->snapshot(), points, options);
  std::printf("pressure 2 cm above the floor: %.1f N/m\n", -field.find("sigma_yy")->value[0]);

  const auto layer = continuum::make_model("layer", {{"F", "1"}, {"h", "0.05"}});
  Eigen::MatrixXd base(1, 2);
  base << 0, -0.05;
  std::printf("below 1 N on a layer of 5 cm: %.3f N/m\n", -layer->stress(base)(0, 1));
  return std::fabs(carried / weight - 1) < 0.01 ? 0 : 1;
}
