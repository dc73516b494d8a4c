-- Of each capture the budget of the fewest bits whose positions stay within half a pixel of the exact path.
SELECT capture, budget, bits, worst
FROM (
    SELECT
        capture,
        budget,
        max(8 * stored_bytes_per_galpixel) AS bits,
        max(worst_px) AS worst,
        row_number() OVER (PARTITION BY capture ORDER BY max(8 * stored_bytes_per_galpixel), max(worst_px)) AS place
    FROM 'sweep/*.parquet'
    GROUP BY capture, budget
    HAVING max(worst_px) <= 0.5
)
WHERE place = 1
ORDER BY capture;
