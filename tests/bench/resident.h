/* Memory that this process has in use, as the system counts it. */
#ifndef BENCH_RESIDENT_H
#define BENCH_RESIDENT_H

/* Bytes now, and the most since the last resident_begin(); 0 where the system does not say. */
double resident_now(void);
double resident_most(void);

/* From now on the most is what there is now, where the system lets it be set. */
void resident_begin(void);

#endif
