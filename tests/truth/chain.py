"""The bending whisker in MuJoCo: a chain of hinges with springs, pushed as ours is.

MOTOR. MuJoCo's first hinge has an inertia that nothing moves, and the torque that brings it to
the cosine's angle at the end of each step.

CHAIN. Hinges with springs, stiff links between. The follicle is the hinge at the base. The shaft is
cut in parts, which shorten towards the tip with the root of the diameter, so that all have about
the same highest frequency; each has two hinges at the Gauss points of its compliance, so that the
tip gives way as the beam's does. Masses and their centres are exact. Each hinge in the outer
part and the tip carry a sphere; the plate is moved back by its radius.

DAMPING. Ours has the ratio 0.05 in each mode. The truth has it by a tendon for each mode, which is
slow. Others have a damper in each hinge in proportion to its spring, with 0.05 in the first mode
("1 mode"), which leaves 2.5e-3 in a push and 3.6e-3 in free motion; or with 0.05 in the fifth, and
tendons that add what the first four lack ("4 modes"). What the integrator "discrete" damps by
itself, a step's length times the spring, is taken off.

BEST SETTINGS, as a grid showed: Newton; solref of two steps, solimp "0.99 0.9999 1e-6".
"implicitfast" wants 0.1 ms and less in contact; "discrete" (since MuJoCo 3.13), which has springs
and contact implicit, holds at 1 ms. "implicit" is as exact as "implicitfast" and slower.
"""
import time

import mujoco
import numpy as np
import rod
from mujoco import rollout
from rod import BEFORE, DENSITY, FOLLICLE, LENGTH, TAPER, YOUNG, ZETA
from scipy.linalg import eigh

MG = 1e6            # Masses in milligrams, so forces in micronewtons: MuJoCo has a least mass.
MOTOR = 1e3 * MG    # Inertia of the motor.
RADIUS = 1e-4       # Of the spheres, m.
TOUCHES = 0.6       # From where on the shaft they are, a share of its length.


def integral(start, end, of):
    x, w = np.polynomial.legendre.leggauss(20)
    return np.sum(w * of((end + start) / 2 + x * (end - start) / 2)) * (end - start) / 2


def line_mass(s):
    return MG * DENSITY * np.pi * rod.diameter(s) ** 2 / 4


def softness(s):
    return 64 / (MG * YOUNG * np.pi * rod.diameter(s) ** 4)


def chain(links):
    """Places and stiffnesses of the hinges."""
    at, stiff = [0.0], [MG * FOLLICLE]
    share = np.linspace(0, 1, links // 2 + 1)
    edges = LENGTH * (1 - (1 - share * (1 - TAPER**-0.5)) ** 2) / (1 - 1 / TAPER)
    for n, (a, b) in enumerate(zip(edges, edges[1:])):
        give = integral(a, b, softness)
        centre = integral(a, b, lambda s: s * softness(s)) / give
        second, third = (integral(a, b, lambda s: (s - centre) ** p * softness(s)) / give
                         for p in (2, 3))
        skew = third / second / 2
        off = np.array([-1, 1]) * np.sqrt(skew**2 + second) + skew
        if n == 0 and links % 2 == 0:
            at.append(centre)
            stiff.append(1 / give)
        else:
            at += list(centre + off)
            stiff += list((off[1] - off[0]) / (np.array([off[1], -off[0]]) * give))
    return np.array(at), np.array(stiff)


def xml(links, axes, damping, step, integrator, contact, tendons=()):
    at, stiff = chain(links)
    normal = np.array([-np.sin(rod.SLANT), -np.cos(rod.SLANT), 0])
    vector = lambda v: " ".join(repr(float(c)) for c in v)
    text = [f'<mujoco><option timestep="{step!r}" integrator="{integrator}" gravity="0 0 0" '
            'solver="Newton" tolerance="1e-10"/>'
            '<compiler inertiafromgeom="false" angle="radian"/>'
            f'<default><geom type="sphere" size="{RADIUS}" conaffinity="0" condim="1" '
            f'solref="{2 * step!r} 1" solimp="0.99 0.9999 1e-6"/></default><worldbody>']
    if contact:
        place = vector(np.array([LENGTH, 0, 0]) - RADIUS * normal)
        text.append('<geom type="plane" size="1 1 1" contype="0" conaffinity="1" '
                    f'pos="{place}" zaxis="{vector(normal)}"/>')
    text.append(f'<body><joint name="motor" axis="0 0 1" armature="{MOTOR}"/>'
                '<inertial pos="0 0 0" mass="1e-3" diaginertia="1e-9 1e-9 1e-9"/>')
    before = 0.0
    for n, (s, end) in enumerate(zip(at, np.append(at[1:], LENGTH))):
        mass = integral(s, end, line_mass)
        centre = integral(s, end, lambda x: x * line_mass(x)) / mass
        inertia = integral(s, end, lambda x: (x - centre) ** 2 * line_mass(x))
        text.append(f'<body pos="{vector([s - before, 0, 0])}">')
        for name, axis in (("z", "0 0 1"), ("y", "0 1 0"))[:axes]:
            text.append(f'<joint name="{name}{n}" axis="{axis}" stiffness="{float(stiff[n])!r}" '
                        f'damping="{float(damping[n])!r}"/>')
        text.append(f'<inertial pos="{vector([centre - s, 0, 0])}" mass="{float(mass)!r}" '
                    f'diaginertia="{vector([inertia / 1e3, inertia, inertia])}"/>')
        if contact and s > TOUCHES * LENGTH:
            text.append("<geom/>")
        before = s
    if contact:
        text.append(f'<geom pos="{vector([LENGTH - before, 0, 0])}"/>')
    text.append("</body>" * (len(at) + 1) + "</worldbody><tendon>")
    for damper, shares in tendons:
        for axis in "zy"[:axes]:
            text.append(f'<fixed damping="{float(damper)!r}">')
            text += [f'<joint joint="{axis}{n}" coef="{float(c)!r}"/>' for n, c in enumerate(shares)]
            text.append("</fixed>")
    return "".join(text) + (f'</tendon><actuator><motor joint="motor" gear="{MOTOR}"/></actuator>'
                            "</mujoco>")


def modes(links):
    """Mass matrix of the straight chain, frequencies, shapes."""
    at, stiff = chain(links)
    text = xml(links, 1, np.zeros(len(at)), 1e-5, "Euler", False)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, mass)
    w2, shapes = eigh(np.diag(stiff), mass[1:, 1:])
    return mass[1:, 1:], np.sqrt(w2), shapes


def model_of(links, axes, step, integrator, contact, damped=1):
    """With the ratio of damping exact in that many modes."""
    mass, omega, shapes = modes(links)
    stiff = chain(links)[1]
    own = step if integrator == "discrete" else 0.0
    every = max(0.0, 2 * ZETA / omega[0 if damped == 1 else damped] - own) if damped < links else 0.0
    lacks = 2 * ZETA * omega - (every + own) * omega**2
    tendons = [(lacks[k], mass @ shapes[:, k]) for k in range(damped) if lacks[k] > 1e-6 * omega[k]]
    text = xml(links, axes, every * stiff, step, integrator, contact, tendons)
    return mujoco.MjModel.from_xml_string(text)


def run(model, push_deg):
    """Moments at the base every 0.5 ms, or step, N m, and thread seconds a simulated second."""
    step, push = model.opt.timestep, np.radians(push_deg)
    angle = rod.motor(np.arange(round(rod.PUSH_S / step) + 1) * step, push)[0]
    torque = np.diff(np.diff(angle, prepend=angle[0]) / step, append=0)[:-1] / step
    data = mujoco.MjData(model)
    data.qpos[0] = -BEFORE
    whole = mujoco.mjtState.mjSTATE_FULLPHYSICS
    state = np.zeros(mujoco.mj_stateSize(model, whole))
    mujoco.mj_getState(model, data, state, whole)
    every = max(1, round(5e-4 / step))
    turned, seconds, warm = [], 0.0, None
    chunk = every * max(1, 2000 // every)
    for first in range(0, len(torque), chunk):
        some = torque[None, first:first + chunk, None]
        start = time.thread_time()
        states = rollout.rollout(model, data, state[None], some, initial_warmstart=warm)[0][0]
        seconds += time.thread_time() - start
        state, warm = states[-1].copy(), data.qacc_warmstart.copy()[None]
        turned.append(states[every - 1::every, 2])
    return -FOLLICLE * np.concatenate(turned), seconds / rod.PUSH_S
