    /* A spring in series: laws on speeds, for compression and release, and what marches with it. */
    PREFIX_real grid[256], viscous_at[2][256], sign_at[2][256], friction_at[2][256],
        factor_at[2][256];
    PREFIX_real gas_past; /* [m] in place of x in the gas force, at the last sample */
    struct PREFIX_spring {
        PREFIX_real stretch, speed, yielding; /* [m], [m/s] behind it, [N] F_ER of Eq. 12 */
        int up, faces; /* direction of the last motion, and of that at the samples */
        int near; /* node below the last speed */
        PREFIX_real beside; /* [N] forces that the rod's motion made */
        PREFIX_real was, smooth; /* [N] signed yield force; its sign law but for the jump */
        PREFIX_real h; /* hysteretic variable in the place of the sign law */
        PREFIX_real z; /* part of the friction that follows the direction */
        PREFIX_real rate;   /* [m/s2] acceleration of the piston in the last step */
        PREFIX_real pulled; /* [N] of the mass, for what the piston is not accelerated as the rod */
    } spring[@MARCHES@];
