typedef PREFIX_real real;

#define K(number) ((real)(number))
#ifdef ERDCTL_FLOAT
#define EXPM1 expm1f
#define POW powf
#define FABS fabsf
#define FLOOR floorf
#else
#define EXPM1 expm1
#define POW pow
#define FABS fabs
#define FLOOR floor
#endif
