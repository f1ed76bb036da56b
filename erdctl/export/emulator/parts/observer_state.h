    PREFIX_damper_state faulty, made, idle; /* the faulty damper under the controller's duty, the
                                       real one under duty_out, and that with no field at all */
    PREFIX_real ideal, unfielded;   /* [N] force of the first and of the last */
