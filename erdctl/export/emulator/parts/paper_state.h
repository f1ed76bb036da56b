    int up, turning;                /* 1: compression, 0: release; any motion yet */
    PREFIX_real healthy, made;      /* [N] yield force of the healthy damper under the controller's
                                       duty, and of the real one under duty_out */
    PREFIX_real settled;            /* [1] duty_out that the model has taken in */
    PREFIX_real steady[4], of[4];   /* [N] steady yield forces of duty and of duty_out, each for
                                       compression and release; sigma and beta that they are of */
