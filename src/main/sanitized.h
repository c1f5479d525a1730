/* IS_SANITIZED: in a build whose faults a sanitizer tells. */
#ifndef COROT_MAIN_SANITIZED_H
#define COROT_MAIN_SANITIZED_H

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define IS_SANITIZED 1
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define IS_SANITIZED 1
#endif

#endif
