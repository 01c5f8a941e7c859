"""The knee as the point that both segments share: it gives the headings' difference without knowing the axis.

The specific force at the knee is R (f + K r) with K = [w x][w x] + [w' x] and r the arm from the sensor to the knee.
Both sensors must agree on it once the second one's world is turned by the heading difference d about the vertical
(Seel and Schauer 2012 for the arms; Weygers and Kok 2020 for the orientation). The vertical components agree whatever
d is: linear least squares for both arms. The horizontal ones, as complex numbers, then give d = arg sum h1 conj(h2)
in closed form, and with d all rows refine the arms. Everything follows from running products of the eight columns (f,
K's three) of both sensors.
"""

from math import atan2, cos, exp, pi, sin, sqrt

from services.biomech.two_sensor_knee.compiled import compiled
from services.biomech.two_sensor_knee.memory import Bench, FloatArray, Memory, Record
from services.biomech.two_sensor_knee.turns import low_pass_gain

REFINEMENTS = 2
LEVELLED_S = 4.0
"""s of levelling after a gap in which nothing is learned of the joint: inclinations are wrong at first, and gravity in
the wrong place looks like an acceleration."""
IDLE, ON_GRID, SOLVED = 0, 1, 2
"""What a sample led to: nothing, products were added, the joint was solved for."""


@compiled
def follow_joint(memory: Memory, bench: Bench, force: FloatArray, dt_s: float) -> int:
    """Take one sample (force (2, 3) m/s^2; rate and R in the bench); IDLE, ON_GRID or SOLVED."""
    knee, parameters = memory.knee, bench.parameters
    gain = low_pass_gain(0.5 / (pi * parameters.joint_cutoff_hz), dt_s)
    for s in range(2):
        low_pass_columns(
            memory.joint_fast[s], memory.joint[s], bench.R[s], bench.rate[s], memory.rate_before[s], force[s],
            gain, dt_s,
        )  # fmt: skip
        for i in range(3):
            memory.rate_before[s, i] = bench.rate[s, i]
    knee.since_products_s += dt_s
    knee.since_solution_s += dt_s
    if knee.since_products_s < parameters.joint_interval_s - 0.5 * dt_s:
        return IDLE
    if knee.has_angle > 0.0 and memory.levels[0].elapsed_s < LEVELLED_S:
        knee.since_products_s = 0.0
        return ON_GRID
    forgetting = exp(-knee.since_products_s / parameters.joint_memory_s)
    add_products(memory, forgetting, knee.since_products_s)
    knee.joint_moving_s *= forgetting
    if knee.joint_power > parameters.joint_power and largest_square(bench.rate) > parameters.moving_rate**2:
        knee.joint_moving_s += knee.since_products_s
    knee.since_products_s = 0.0
    if knee.since_solution_s < parameters.joint_solve_s:
        return ON_GRID
    knee.since_solution_s = 0.0
    return SOLVED if solve_joint(memory, bench) else ON_GRID


@compiled
def low_pass_columns(
    fast: FloatArray,
    slow: FloatArray,
    R: FloatArray,
    rate: FloatArray,
    rate_before: FloatArray,
    force: FloatArray,
    gain: float,
    dt_s: float,
) -> None:
    """Columns R f and R K of one sensor, (3, 4), through two low-passes in the world: both get the same delay."""
    wx, wy, wz = rate[0], rate[1], rate[2]
    ax, ay, az = (wx - rate_before[0]) / dt_s, (wy - rate_before[1]) / dt_s, (wz - rate_before[2]) / dt_s
    # [w x][w x] = w w' - |w|^2 I
    xx, yy, zz = -(wy * wy + wz * wz), -(wx * wx + wz * wz), -(wx * wx + wy * wy)
    xy, xz, yz = wx * wy, wx * wz, wy * wz
    for i in range(3):
        rx, ry, rz = R[i, 0], R[i, 1], R[i, 2]
        columns = (
            rx * force[0] + ry * force[1] + rz * force[2],
            rx * xx + ry * (xy + az) + rz * (xz - ay),
            rx * (xy - az) + ry * yy + rz * (yz + ax),
            rx * (xz + ay) + ry * (yz - ax) + rz * zz,
        )
        for k in range(4):
            fast[i, k] += gain * (columns[k] - fast[i, k])
            slow[i, k] += gain * (fast[i, k] - slow[i, k])


@compiled
def add_products(memory: Memory, forgetting: float, dt_s: float) -> None:
    """Forget, and add the products of the eight columns, weighed by time."""
    joint = memory.joint
    for i in range(8):
        si, ki = i // 4, i % 4
        vertical_i, z_i, x_i = joint[si, 1, ki], joint[si, 2, ki], joint[si, 0, ki]
        for j in range(i, 8):
            sj, kj = j // 4, j % 4
            z_j, x_j = joint[sj, 2, kj], joint[sj, 0, kj]
            # (z_i + i x_i) conj(z_j + i x_j)
            memory.vertical[i, j] = forgetting * memory.vertical[i, j] + dt_s * vertical_i * joint[sj, 1, kj]
            memory.horizontal_real[i, j] = forgetting * memory.horizontal_real[i, j] + dt_s * (z_i * z_j + x_i * x_j)
            memory.horizontal_imaginary[i, j] = forgetting * memory.horizontal_imaginary[i, j] + dt_s * (
                x_i * z_j - z_i * x_j
            )
    knee = memory.knee
    power = joint[0, 2, 0] ** 2 + joint[0, 0, 0] ** 2
    knee.joint_power += low_pass_gain(1.0, dt_s) * (power - knee.joint_power)


@compiled
def largest_square(rate: FloatArray) -> float:
    """Square of the faster sensor's rate, (rad/s)^2."""
    first = rate[0, 0] ** 2 + rate[0, 1] ** 2 + rate[0, 2] ** 2
    second = rate[1, 0] ** 2 + rate[1, 1] ** 2 + rate[1, 2] ** 2
    return float(max(first, second))


@compiled
def solve_joint(memory: Memory, bench: Bench) -> bool:
    """Arms, heading and coherence from the running products; False where the equations have no solution."""
    knee = memory.knee
    if not solve_arms(memory, bench, 0.0, 0.0):
        return False
    heading_and_coherence(memory)
    for _ in range(REFINEMENTS):
        if not solve_arms(memory, bench, 1.0, knee.joint_heading):
            return False
        heading_and_coherence(memory)
    return True


@compiled
def solve_arms(memory: Memory, bench: Bench, horizontal: float, heading: float) -> bool:
    """Least squares for both arms: vertical rows alone (horizontal = 0) or all rows with a known heading (1).

    Unknowns p = (r1, -r2); columns 1-3 and 5-7 against column 0 minus column 4.
    """
    parameters = bench.parameters
    c, s = horizontal * cos(heading), horizontal * sin(heading)
    A = bench.normal
    ridge = parameters.joint_memory_s * (parameters.joint_noise / parameters.arm_std) ** 2
    for i in range(6):
        row = 1 + i + i // 3
        for j in range(6):
            column = 1 + j + j // 3
            A[i, j] = joint_product(memory, row, column, horizontal, c, s)
        A[i, i] += 0.02 * ridge
        A[i, 6] = joint_product(memory, row, 4, horizontal, c, s) - joint_product(memory, row, 0, horizontal, c, s)
    if not solve_in_place(A):
        return False
    for i in range(3):
        memory.arms[0, i] = A[i, 6]
        memory.arms[1, i] = -A[3 + i, 6]
    return True


@compiled
def joint_product(memory: Memory, i: int, j: int, horizontal: float, c: float, s: float) -> float:
    """Sum of products of columns i and j, the second sensor's horizontal parts turned by the heading (cos c, sin s).

    Re((a_i) conj(a_j)), a_i = h_i for the first sensor and exp(i d) h_i for the second.
    """
    low, high = min(i, j), max(i, j)
    real, imaginary = memory.horizontal_real[low, high], memory.horizontal_imaginary[low, high]
    if low < 4 <= high:
        # h_low conj(h_high) exp(-i d)
        return float(memory.vertical[low, high] + c * real + s * imaginary)
    return float(memory.vertical[low, high] + horizontal * real)


@compiled
def solve_in_place(A: FloatArray) -> bool:
    """Cholesky solution of the symmetric A[:6, :6] x = A[:6, 6]; x is left in the last column."""
    for j in range(6):
        for k in range(j):
            for i in range(j, 6):
                A[i, j] -= A[i, k] * A[j, k]
        if not A[j, j] > 1e-9:
            return False
        root = sqrt(A[j, j])
        for i in range(j, 6):
            A[i, j] /= root
    for i in range(6):
        for k in range(i):
            A[i, 6] -= A[i, k] * A[k, 6]
        A[i, 6] /= A[i, i]
    for i in range(5, -1, -1):
        for k in range(i + 1, 6):
            A[i, 6] -= A[k, i] * A[k, 6]
        A[i, 6] /= A[i, i]
    return True


@compiled
def heading_and_coherence(memory: Memory) -> None:
    """d = arg sum h1 conj(h2), |sum| / sqrt(sum |h1|^2 sum |h2|^2), of the horizontal acceleration of the knee."""
    knee, arms = memory.knee, memory.arms
    real, imaginary, first, second = 0.0, 0.0, 0.0, 0.0
    for i in range(4):
        for j in range(4):
            one = (1.0 if i == 0 else arms[0, i - 1]) * (1.0 if j == 0 else arms[0, j - 1])
            two = (1.0 if i == 0 else arms[1, i - 1]) * (1.0 if j == 0 else arms[1, j - 1])
            both = (1.0 if i == 0 else arms[0, i - 1]) * (1.0 if j == 0 else arms[1, j - 1])
            low, high = min(i, j), max(i, j)
            first += one * memory.horizontal_real[low, high]
            second += two * memory.horizontal_real[4 + low, 4 + high]
            real += both * memory.horizontal_real[i, 4 + j]
            imaginary += both * memory.horizontal_imaginary[i, 4 + j]
    knee.joint_heading = atan2(imaginary, real)
    knee.joint_coherence = sqrt(real * real + imaginary * imaginary) / (sqrt(max(first * second, 0.0)) + 1e-9)


@compiled
def is_joint_trusted(knee: Record, parameters: Record) -> bool:
    """Whether enough of the knee's motion was seen, and both sensors agree on it."""
    return bool(knee.joint_moving_s >= parameters.joint_motion_s and knee.joint_coherence >= parameters.joint_coherence)
