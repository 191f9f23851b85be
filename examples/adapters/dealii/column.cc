// Biot's column by deal.II: displacement Q2, pressure Q1 on quadrilaterals, backward Euler. deal.II 9.4 with MPI and UMFPACK.
// column PARAMETERS OUT: adapter.py writes PARAMETERS; writes OUT/column.pvd, a PVD of PVTU.
#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/vector_tools.h>

#include <fstream>
#include <iostream>

using namespace dealii;

int main(int argc, char **argv) {
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  ParameterHandler given;
  for (const char *name : {"lambda", "mu", "storage", "mobility", "width", "height", "load", "largest step"})
    given.declare_entry(name, "0", Patterns::Double());
  given.declare_entry("cells", "1", Patterns::Integer());
  given.declare_entry("times", "", Patterns::List(Patterns::Double()));
  given.parse_input(argv[1]);
  const double lambda = given.get_double("lambda"), mu = given.get_double("mu"), load = given.get_double("load");
  const double storage = given.get_double("storage"), mobility = given.get_double("mobility");
  const auto times = Utilities::string_to_double(Utilities::split_string_list(given.get("times")));
  const std::string out = std::string(argv[2]) + "/";

  Triangulation<2> grid;  // colorize: 0 left, 1 right, 2 base, 3 top
  GridGenerator::subdivided_hyper_rectangle(
      grid, {1, static_cast<unsigned>(given.get_integer("cells"))}, Point<2>(0, 0),
      Point<2>(given.get_double("width"), given.get_double("height")), true);
  const FESystem<2> element(FE_Q<2>(2), 2, FE_Q<2>(1), 1);
  DoFHandler<2> dofs(grid);
  dofs.distribute_dofs(element);
  AffineConstraints<double> fixed;
  const auto hold = [&](types::boundary_id border, std::vector<bool> components) {
    VectorTools::interpolate_boundary_values(dofs, border, Functions::ZeroFunction<2>(3), fixed, ComponentMask(components));
  };
  hold(0, {true, false, false});
  hold(1, {true, false, false});
  hold(2, {false, true, false});
  hold(3, {false, false, true});
  fixed.close();

  DynamicSparsityPattern dynamic(dofs.n_dofs());
  DoFTools::make_sparsity_pattern(dofs, dynamic, fixed);
  SparsityPattern pattern;
  pattern.copy_from(dynamic);
  SparseMatrix<double> matrix(pattern), history(pattern);
  Vector<double> solution(dofs.n_dofs()), right(dofs.n_dofs()), loads(dofs.n_dofs());
  const FEValuesExtractors::Vector u(0);
  const FEValuesExtractors::Scalar p(2);

  const auto assemble = [&](double step) {
    matrix = 0;
    history = 0;
    loads = 0;
    const unsigned n = element.n_dofs_per_cell();
    FEValues<2> inside(element, QGauss<2>(3), update_values | update_gradients | update_JxW_values);
    FEFaceValues<2> face(element, QGauss<1>(3), update_values | update_JxW_values);
    FullMatrix<double> a(n, n), m(n, n);
    Vector<double> f(n);
    std::vector<types::global_dof_index> index(n);
    for (const auto &cell : dofs.active_cell_iterators()) {
      a = 0;
      m = 0;
      f = 0;
      inside.reinit(cell);
      for (const unsigned q : inside.quadrature_point_indices())
        for (unsigned i = 0; i < n; i++)
          for (unsigned j = 0; j < n; j++) {
            const double r = inside[p].value(i, q), weight = inside.JxW(q);
            const double held = (inside[u].divergence(j, q) + storage * inside[p].value(j, q)) * r;
            m(i, j) += held * weight;
            a(i, j) += (2 * mu * inside[u].symmetric_gradient(i, q) * inside[u].symmetric_gradient(j, q) +
                        lambda * inside[u].divergence(i, q) * inside[u].divergence(j, q) -
                        inside[p].value(j, q) * inside[u].divergence(i, q) + held +
                        step * mobility * inside[p].gradient(i, q) * inside[p].gradient(j, q)) *
                       weight;
          }
      for (const auto &side : cell->face_iterators())
        if (side->at_boundary() && side->boundary_id() == 3) {
          face.reinit(cell, side);
          for (const unsigned q : face.quadrature_point_indices())
            for (unsigned i = 0; i < n; i++) f(i) -= load * face[u].value(i, q)[1] * face.JxW(q);
        }
      cell->get_dof_indices(index);
      fixed.distribute_local_to_global(a, f, index, matrix, loads);
      history.add(index, m);
    }
  };

  Timer clock;
  double now = 0;
  std::vector<std::pair<double, std::string>> written;
  for (unsigned output = 0; output < times.size(); output++) {
    const int steps = std::ceil((times[output] - now) / given.get_double("largest step") - 1e-9);
    assemble((times[output] - now) / steps);
    SparseDirectUMFPACK factors;
    factors.initialize(matrix);
    for (int k = 0; k < steps; k++) {
      history.vmult(right, solution);
      right += loads;
      fixed.set_zero(right);
      factors.vmult(solution, right);
      fixed.distribute(solution);
    }
    now = times[output];
    DataOut<2> data;
    data.attach_dof_handler(dofs);
    using namespace DataComponentInterpretation;
    data.add_data_vector(
        solution, {"displacement", "displacement", "pressure"}, DataOut<2>::type_dof_data,
        {component_is_part_of_vector, component_is_part_of_vector, component_is_scalar});
    data.build_patches();  // order 1: the corners of each cell
    written.emplace_back(now, data.write_vtu_with_pvtu_record(out, "column", output, MPI_COMM_WORLD, 4));
  }
  std::ofstream record(out + "column.pvd");
  DataOutBase::write_pvd_record(record, written);
  std::cout << "solved in " << clock.wall_time() << " s" << std::endl;
}
