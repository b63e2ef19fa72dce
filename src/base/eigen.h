/* Principal axes of a symmetric 3 x 3 matrix by cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, 8.5).
 */
#ifndef TL_EIGEN_H
#define TL_EIGEN_H

#include "talus/types.h"

/* a = R diag(values) R^T with R the matrix of *axes (a unit quaternion, right-handed). A diagonal matrix gives the
 * identity. The error is about 1e-7 of the largest value. */
void tl_principal_axes(const talus_mat3 *a, talus_quat *axes, float values[3]);

#endif
