/* The names of the kernels. Their files are compiled once for each instruction set, with
   COROT_KERNELS defined as what is put behind the names; without, these are the functions of
   kernel_choose.c, which call the build for this processor. A kernel that is missing here is
   defined several times. */
#ifndef COROT_CORE_SOLID_KERNEL_NAMES_H
#define COROT_CORE_SOLID_KERNEL_NAMES_H

#ifdef COROT_KERNELS
#define KERNEL_JOINED(name, suffix) name##suffix
#define KERNEL_NAME(name, suffix) KERNEL_JOINED(name, suffix)
#define corot_kernel_force KERNEL_NAME(corot_kernel_force, COROT_KERNELS)
#define corot_kernel_energy KERNEL_NAME(corot_kernel_energy, COROT_KERNELS)
#define corot_kernel_frames KERNEL_NAME(corot_kernel_frames, COROT_KERNELS)
#define corot_kernel_spin KERNEL_NAME(corot_kernel_spin, COROT_KERNELS)
#define corot_kernel_internal KERNEL_NAME(corot_kernel_internal, COROT_KERNELS)
#define corot_kernel_diagonals KERNEL_NAME(corot_kernel_diagonals, COROT_KERNELS)
#define corot_kernel_tangent KERNEL_NAME(corot_kernel_tangent, COROT_KERNELS)
#define corot_kernel_derivative KERNEL_NAME(corot_kernel_derivative, COROT_KERNELS)
#define corot_kernel_handed_force KERNEL_NAME(corot_kernel_handed_force, COROT_KERNELS)
#define corot_kernel_handed_derivative KERNEL_NAME(corot_kernel_handed_derivative, COROT_KERNELS)
#define corot_kernel_hand_down KERNEL_NAME(corot_kernel_hand_down, COROT_KERNELS)
#define corot_kernel_turning_force KERNEL_NAME(corot_kernel_turning_force, COROT_KERNELS)
#define corot_kernel_turning_derivative KERNEL_NAME(corot_kernel_turning_derivative, COROT_KERNELS)
#define corot_kernel_frames_change KERNEL_NAME(corot_kernel_frames_change, COROT_KERNELS)
#endif

#endif
