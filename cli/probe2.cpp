#include "prt/bake.h"
#include "prt/compress.h"
#include "prt/error_measures.h"
#include "prt/error.h"
#include <cstdio>
#include <cstdlib>
using namespace prt;
int main(int c,char**v){ try{ auto d=load_gltf(v[1]); auto s=extract_scene(d);
 auto areas=receiver_areas(s); BakeOptions o; auto b=bake(s,o);
 for(int k=2;k+1<c;k+=2) for(auto f:{WeightFormat::float32,WeightFormat::snorm8}){CompressOptions co;co.clusters=atoi(v[k]);co.components=atoi(v[k+1]);co.weights=f; auto r=compress(b.baked.transfer,areas,co);
 printf("%d x %d fmt %d: %.5f  (%.5f -> %.5f, %zu it) %.2f s clusters %d\n",co.clusters,co.components,int(f),relative_l2(b.baked.transfer,decode(r.transfer),areas),r.statistics.relative_l2_by_iteration.front(),r.statistics.relative_l2_by_iteration.back(),r.statistics.relative_l2_by_iteration.size(),r.statistics.seconds,r.statistics.clusters);}
 }catch(std::exception&e){fprintf(stderr,"%s\n",e.what());return 1;} }
